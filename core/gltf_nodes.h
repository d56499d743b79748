// The tree of a document's nodes. Private to gltf_file.h's implementation.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/gltf_document.h"
#include "core/math.h"
#include "core/raw_asset.h"

namespace ensemble {

struct GltfNode {
  std::string name;  ///< empty where the file gives none
  std::int32_t parent = -1;
  std::vector<std::uint32_t> children;
  Transform local;         ///< what animations replace
  bool has_shear = false;  ///< its matrix is more than `local` can say
  glm::dmat4 world_from_node{1.0};
  std::optional<std::uint32_t> mesh, skin;
  bool in_scene = false;  ///< below a root of the default scene

  /// The name, else "node N".
  std::string label(std::size_t index) const;
};

struct GltfNodes {
  std::vector<GltfNode> nodes;               ///< as in the file
  std::vector<std::uint32_t> parents_first;  ///< every node, after its parent
};

/// Reads the tree. @throws InputError for cycles, nodes with two parents, numbers that are not
/// finite, and scenes that name a child.
GltfNodes readNodes(const GltfDocument& document);

/// The same as toMatrix(), in double precision.
glm::dmat4 toMatrixDouble(const Transform& transform);

}  // namespace ensemble
