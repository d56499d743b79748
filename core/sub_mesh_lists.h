// naive | prefitted | tagged: which index lists exist and which of them a character shows.
//
// One pure function for `report` and the renderer, so that the figures are of what is drawn
// (design 5). The three techniques differ in nothing else.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/ids.h"
#include "core/wardrobe.h"
#include "shaders/shared/vertex.h"

namespace ensemble {

enum class Technique : std::uint8_t { kNaive, kPrefitted, kTagged };
inline constexpr Technique kAllTechniques[] = {Technique::kNaive, Technique::kPrefitted, Technique::kTagged};
const char* toString(Technique technique);  ///< "naive", "prefitted", "tagged"
std::optional<Technique> parseTechnique(std::string_view name);

/// A character's clothes: items, ascending and each once (design 4). Empty: the bare body.
using Combination = std::vector<ItemId>;

/// Distinct vertices that the GPU holds once, renumbered by first use. At most one body mesh per
/// template (naive, tagged) or per distinct visible body (pre-fitted), one mesh per distinct garment part.
struct Mesh {
  std::vector<GpuVertex> vertices;
  bool wide_indices = false;  ///< 32-bit indices, where there are more than 65,536 vertices
};

enum class SubMeshKind : std::uint8_t { kGarment, kBody };

/// Faces of a mesh, stored once however many sub-meshes use them.
struct IndexList {
  MeshId mesh;
  std::vector<std::uint32_t> indices;  ///< 3 per face, into the mesh, in vertex-cache order
  /// Per face of the list: its FaceId in the template (is_template), else its number in its part.
  std::vector<std::uint32_t> source_faces;
  bool is_template = false;
};

/// What one queue draws: an index list with a material.
struct SubMesh {
  SubMeshKind kind = SubMeshKind::kBody;
  IndexListId list;
  std::uint32_t material = 0;  ///< index into SubMeshLists::materials
  std::uint32_t region = 0;    ///< kBody: RegionId; kGarment: index into garment_names
  /// Added to the list's source_faces: a garment's faces are numbered through its parts, and body
  /// faces that only an outfit has follow the template's.
  std::uint32_t source_face_offset = 0;
  Slot slot = Slot::kFull;  ///< kGarment: of its item
  /// That of most faces of its item (of a `full` one: of its garment), with which trimmings are coloured; of
  /// body `material`.
  std::uint32_t main_material = 0;
  bool has_trimmings = false;  ///< kGarment: its garment has several materials
  /// kGarment, naive: a piece that is hidden where it is shown so; it casts no shadow.
  bool is_covered = false;
};

/// A material and where it came from.
struct ListMaterial {
  RawMaterial material;  ///< `image` indexes SubMeshLists::images
  bool is_skin = false;  ///< a material of the body: tinted as skin, else as cloth
};

struct SubMeshLists {
  Technique technique = Technique::kTagged;
  PerId<MeshId, Mesh> meshes;
  PerId<IndexListId, IndexList> index_lists;
  PerId<SubMeshId, SubMesh> sub_meshes;    ///< garments first, then the body by region: draw order
  std::vector<ListMaterial> materials;     ///< distinct
  std::vector<RawImage> images;            ///< distinct
  std::vector<std::string> garment_names;  ///< distinct
  std::vector<Combination> combinations;
  /// Per combination: its sub-meshes, ascending.
  std::vector<std::vector<SubMeshId>> shown;
  /// Distinct: 1 bit per template face, set where hidden, 32 faces a word.
  std::vector<std::vector<std::uint32_t>> hidden_sets;
  std::vector<std::uint32_t> hidden_set;  ///< per combination: index into hidden_sets

  /// Vertices and indices of all meshes as the GPU holds them.
  std::uint64_t meshBytes() const;
};

/// Builds the lists for some combinations of a wardrobe. Deterministic; equal geometry and equal visible
/// sets are stored once. The visible faces of a combination are those that every one of its items leaves
/// visible; what is left of an item's garments follows from Wardrobe::hidden_under. Faces of a body keep one
/// relative order in every list of every technique (a subsequence of the template's vertex-cache order), so
/// that equal depths resolve alike and pictures are the same.
/// @pre combinations are valid and distinct.
SubMeshLists buildSubMeshLists(const Wardrobe& wardrobe, std::span<const Combination> combinations,
                               Technique technique);

/// Bytes of the template and the distinct garments, in the same formats: no technique that can
/// show each outfit needs less (interfaces.md, report).
std::uint64_t lowerBoundBytes(const Wardrobe& wardrobe, std::span<const Combination> combinations);

/// A vertex in the GPU's format. Weights are rounded so that they sum to exactly 65535.
GpuVertex packVertex(const RawVertex& vertex);

}  // namespace ensemble
