// A wardrobe: one template body and the items that dress it. Read here, written by assetpipe/.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/clip.h"
#include "core/ids.h"
#include "core/raw_asset.h"
#include "core/slots.h"

namespace ensemble {

inline constexpr const char* kWardrobeSchema = "ensemble.wardrobe/1";

enum class Visibility : std::uint8_t { kFull, kPartial, kHidden };
const char* toString(Visibility visibility);  ///< "full", "partial", "hidden"

/// A region of the template: faces first_face .. first_face + face_count, and likewise vertices.
struct Region {
  std::string name;
  std::uint32_t first_face = 0, face_count = 0;
  std::uint32_t first_vertex = 0, vertex_count = 0;
};

/// Faces of one region and one material, consecutive in the template.
struct BodyPart {
  RegionId region;
  std::uint32_t material = 0;  ///< index into TemplateBody::materials
  std::uint32_t first_face = 0, face_count = 0;
};

/// The template person. Faces and vertices are in template.glb's order: regions one after the
/// other, inside a region the source's order. A vertex (wedge) belongs to one region.
struct TemplateBody {
  PerVertex<RawVertex> vertices;
  PerFace<Triangle> faces;              ///< indices into vertices
  PerVertex<VertexCollapse> collapses;  ///< its levels of detail; empty where it has none
  PerFace<RegionId> region_of_face;
  PerRegion<Region> regions;
  std::vector<BodyPart> parts;  ///< in face order; together they cover every face once
  std::vector<RawMaterial> materials;
  std::vector<RawImage> images;
  RawSkeleton skeleton;
  std::vector<Clip> clips;
};

/// Triangles of one material in an item: of a garment, or body faces that the template lacks.
using ItemPart = RawPrimitive;

struct Garment {
  std::string name;
  std::vector<ItemPart> parts;  ///< materials index Item::materials
};

/// Body faces of an outfit that match no face of the template (a shoe that reshapes the foot).
struct ExtraBodyPart {
  RegionId region;
  ItemPart part;
};

/// How a region shows under an item.
struct RegionTag {
  Visibility visibility = Visibility::kFull;
  std::uint32_t visible_faces = 0;  ///< template faces that show, and extra body faces
};

/// One outfit file (design 4): garments, and the set of template faces that show under it.
struct Item {
  std::string name;
  Slot slot = Slot::kFull;
  int layer = 0;
  std::vector<Garment> garments;
  std::vector<ExtraBodyPart> extra_body;
  PerFace<std::uint8_t> visible;  ///< 1 where the template's face shows, #F of the template
  /// The level of detail from which on a face's `visible` is the other way round, 0: none does; #F, or empty
  /// where none of any face does.
  PerFace<std::uint8_t> turns_at;
  PerRegion<RegionTag> tags;
  std::vector<RawMaterial> materials;
  std::vector<RawImage> images;

  /// Whether a face of the template shows under the item at a level of detail.
  bool showsAt(FaceId face, std::uint32_t level) const {
    const bool turns = !turns_at.empty() && turns_at[face] != 0 && level >= turns_at[face];
    return (visible[face] != 0) != turns;
  }
  std::uint32_t garmentFaceCount() const;
  std::uint32_t visibleBodyFaceCount() const;  ///< over all regions, extra faces included
  std::uint32_t dedicatedFaceCount() const;    ///< visible faces of partial regions
};

/// Calls take(vertex) for the vertices of an item: its garments' and those of its own body parts.
template <class Take>
void forEachVertex(const Item& item, const Take& take) {
  for (const Garment& garment : item.garments) {
    for (const ItemPart& part : garment.parts) {
      for (const RawVertex& vertex : part.vertices) take(vertex);
    }
  }
  for (const ExtraBodyPart& extra : item.extra_body) {
    for (const RawVertex& vertex : extra.part.vertices) take(vertex);
  }
}

/// Two items that are worn together, one over the other (isWornOver).
struct ItemPair {
  ItemId inner, outer;
  auto operator<=>(const ItemPair&) const = default;
};

/// Faces of an item's garments, numbered through all parts of all garments: 1 where hidden, else 0.
using HiddenGarmentFaces = std::vector<std::uint8_t>;

struct Wardrobe {
  std::filesystem::path folder;
  std::string template_file;                   ///< relative to folder
  std::string template_sha256, geometry_hash;  ///< hex
  TemplateBody body;
  PerItem<Item> items;               ///< in the manifest's order
  PerItem<std::string> item_files;   ///< relative to folder
  PerItem<std::string> item_sha256;  ///< hex, of the files; empty where there are none
  /// What the outer item of a pair hides of the inner one (design 4); a pair that is not here hides nothing.
  /// Loading leaves it empty: found where people wear such pairs (assetpipe/find_layers.h).
  std::map<ItemPair, HiddenGarmentFaces> hidden_under;
};

/// Loads a wardrobe folder: manifest checked against its JSON Schema, every file against its
/// SHA-256, every count in the manifest against what the files hold.
/// @throws InputError naming the file and what to do; SystemError if a file can't be read.
Wardrobe loadWardrobe(const std::filesystem::path& folder);

}  // namespace ensemble
