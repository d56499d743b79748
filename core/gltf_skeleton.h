// Skins and the skeleton they share, and the way of vertices into model space. Private to
// gltf_file.h's implementation.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "core/gltf_nodes.h"
#include "core/raw_asset.h"

namespace ensemble {

/// One skin of the file.
struct GltfSkin {
  std::vector<std::uint32_t> nodes;          ///< of each joint slot
  std::vector<glm::dmat4> joint_from_mesh;   ///< inverse bind matrices, identities if left out
  std::vector<glm::dmat4> world_from_mesh;   ///< B_j: how the joint moves the mesh at rest
  std::vector<bool> carries_weight;          ///< per slot, filled in while meshes are read
  std::vector<std::uint16_t> joint_of_slot;  ///< index into RawSkeleton::joints
  glm::dmat4 model_from_mesh{1.0};           ///< B
  bool used = false;                         ///< by a mesh in the scene
};

struct GltfSkeleton {
  RawSkeleton skeleton;
  std::vector<GltfSkin> skins;  ///< as in the file
  std::map<std::uint32_t, std::uint32_t> bone_of_node;
  std::map<std::uint32_t, std::uint16_t> joint_of_node;
  std::vector<std::int32_t> nearest_joint;  ///< per node: the joint that it is or is below, or -1
  /// The skins do not agree on how the figure stood when it was bound: vertices are brought to rest by
  /// skinning them.
  bool rebound_at_rest = false;
};

/// Reads the skins' joints and inverse bind matrices. @throws InputError
std::vector<GltfSkin> readSkins(const GltfDocument& document, const GltfNodes& tree);

/// Joins the skins to one skeleton and settles each skin's model_from_mesh. For skins that agree, all
/// joints that carry weight, B_j = world(joint at rest) * inverse bind is one matrix, B, and vertices
/// end where a viewer shows them at rest. In a file saved in a pose there is no such matrix; then B is
/// the identity or the place of the armature above the joints, whichever is nearer to the root joint's.
/// Without skins, the bones are the nodes that clips move, and their ancestors.
/// @throws InputError
GltfSkeleton joinSkins(const GltfDocument& document, const GltfNodes& tree, std::vector<GltfSkin> skins,
                       std::vector<std::string>& warnings);

/// Brings a mesh node's vertices from mesh space into model space: `SkinBinding::joints` from the
/// skin's slots to joints; rigid meshes below a joint are bound to it. Mirrored faces are turned back.
void moveToModelSpace(const GltfSkeleton& skeleton, const GltfNodes& tree, std::uint32_t node,
                      RawMeshNode& mesh);

}  // namespace ensemble
