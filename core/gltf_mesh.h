// Meshes: primitives of every encoding as plain triangles. Private to gltf_file.h's implementation.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/gltf_document.h"
#include "core/gltf_material.h"
#include "core/gltf_nodes.h"
#include "core/gltf_skeleton.h"
#include "core/raw_asset.h"

namespace ensemble {

/// What reading the meshes of a document takes and fills in.
struct MeshReading {
  const GltfDocument& document;
  const GltfNodes& tree;
  const std::vector<GltfMaterial>& materials;
  std::vector<GltfSkin>& skins;  ///< carries_weight is filled in
  DroppedList& dropped;
  std::vector<std::string>& warnings;
  std::uint64_t vertices_left, faces_left;  ///< of the limits

  /// The mesh of a node, in mesh space: skin bindings name slots of the node's skin, normals are 0
  /// where the file has none. `material` indexes `materials`. Primitives without triangles are left
  /// out. @throws InputError @pre the node has a mesh
  RawMeshNode readMeshNode(std::uint32_t node);
};

}  // namespace ensemble
