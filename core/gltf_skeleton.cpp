// glTF 2.0, sections 3.7.3 (skins).
#include "core/gltf_skeleton.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/gltf_accessor.h"

namespace ensemble {
namespace {

constexpr double kTolerance = 1e-4;  // 0.1 mm in a mesh of metres

/// How far two affine matrices are apart: relative in the linear part, metres in the translation.
double distance(const glm::dmat4& a, const glm::dmat4& b) {
  double size = 1e-12, difference = 0.0;
  for (int column = 0; column < 3; ++column) {
    size = std::max({size, glm::length(a[column]), glm::length(b[column])});
    difference = std::max(difference, glm::length(a[column] - b[column]));
  }
  return std::max(difference / size, glm::length(a[3] - b[3]));
}

const glm::dmat4 kIdentity(1.0);

/// Whether a matrix has no inverse worth the name: a node of scale 0 stands above.
bool isFlat(const glm::dmat4& matrix) { return std::abs(glm::determinant(matrix)) < 1e-18; }

std::vector<glm::dmat4> readInverseBinds(const GltfDocument& document, const JsonRef& skin,
                                         std::size_t count) {
  std::vector<glm::dmat4> matrices(count, kIdentity);
  const auto accessor = document.findIndex(skin, "inverseBindMatrices", "accessors");
  if (!accessor) return matrices;
  const JsonRef ref = skin.require("inverseBindMatrices");
  const GltfAccessor described = describeAccessor(document, *accessor);
  if (described.count < count || described.count > document.options().max_joints) {
    ref.fail(fmt::format("{} inverse bind matrices for {} joints", described.count, count));
  }
  const std::vector<float> numbers = readFloats(document, *accessor, 16);
  for (std::size_t joint = 0; joint < count; ++joint) {
    for (int i = 0; i < 16; ++i) {
      matrices[joint][i / 4][i % 4] = static_cast<double>(numbers[joint * 16 + static_cast<std::size_t>(i)]);
    }
    const glm::dmat4& m = matrices[joint];
    if (glm::length(glm::dvec4(m[0][3], m[1][3], m[2][3], m[3][3] - 1.0)) > 1e-5) {
      ref.fail(fmt::format("matrix {} is not affine: its last row must be 0 0 0 1", joint));
    }
    for (int column = 0; column < 4; ++column) matrices[joint][column][3] = column == 3 ? 1.0 : 0.0;
    if (glm::determinant(m) == 0.0) ref.fail(fmt::format("matrix {} has no inverse", joint));
  }
  return matrices;
}

// Every node of `wanted` and its ancestors, in the file's order except that parents come first.
void addBones(const GltfDocument& document, const GltfNodes& tree, const std::set<std::uint32_t>& wanted,
              GltfSkeleton& result, std::vector<std::string>& warnings) {
  std::vector<std::uint32_t> chain;
  std::set<std::uint32_t> needed;
  for (std::uint32_t node : wanted) {
    while (needed.insert(node).second && tree.nodes[node].parent >= 0) {
      node = static_cast<std::uint32_t>(tree.nodes[node].parent);
    }
  }
  for (const std::uint32_t first : needed) {
    for (std::int32_t node = static_cast<std::int32_t>(first);
         node >= 0 && !result.bone_of_node.contains(static_cast<std::uint32_t>(node));
         node = tree.nodes[static_cast<std::size_t>(node)].parent) {
      chain.push_back(static_cast<std::uint32_t>(node));
    }
    for (; !chain.empty(); chain.pop_back()) {
      const GltfNode& node = tree.nodes[chain.back()];
      const auto parent = result.bone_of_node.find(static_cast<std::uint32_t>(node.parent));
      const std::int32_t parent_bone = node.parent < 0 ? -1 : static_cast<std::int32_t>(parent->second);
      result.bone_of_node[chain.back()] = static_cast<std::uint32_t>(result.skeleton.bones.size());
      result.skeleton.bones.push_back({node.label(chain.back()), parent_bone, node.local});
      if (node.has_shear) {
        warnings.push_back(
            fmt::format("bone '{}' has a matrix with shear, which is left out", node.label(chain.back())));
      }
    }
  }
  if (result.skeleton.bones.size() > document.options().max_nodes) {
    document.root().fail("too many bones", "split the file");
  }
}

// The nearest ancestor of the skin's first root joint that is no joint itself.
glm::dmat4 armaturePlace(const GltfNodes& tree, const GltfSkin& skin, std::size_t root_slot) {
  const std::int32_t parent = tree.nodes[skin.nodes[root_slot]].parent;
  return parent < 0 ? kIdentity : tree.nodes[static_cast<std::size_t>(parent)].world_from_node;
}

// For every node, the nearest node of `joints` that is itself or stands above it, or -1.
std::vector<std::int32_t> nearestOf(const GltfNodes& tree, const std::set<std::uint32_t>& joints) {
  std::vector<std::int32_t> nearest(tree.nodes.size(), -1);
  for (const std::uint32_t node : tree.parents_first) {
    const std::int32_t parent = tree.nodes[node].parent;
    if (joints.contains(node)) {
      nearest[node] = static_cast<std::int32_t>(node);
    } else if (parent >= 0) {
      nearest[node] = nearest[static_cast<std::size_t>(parent)];
    }
  }
  return nearest;
}

// The first joint none of whose ancestors is a joint.
std::size_t rootSlot(const GltfNodes& tree, const GltfSkin& skin) {
  const auto nearest = nearestOf(tree, std::set<std::uint32_t>(skin.nodes.begin(), skin.nodes.end()));
  for (std::size_t slot = 0; slot < skin.nodes.size(); ++slot) {
    const std::int32_t parent = tree.nodes[skin.nodes[slot]].parent;
    if (parent < 0 || nearest[static_cast<std::size_t>(parent)] < 0) return slot;
  }
  return 0;
}

glm::dmat4 settleModelFromMesh(const GltfNodes& tree, const GltfSkin& skin) {
  const std::size_t root = rootSlot(tree, skin);
  const glm::dmat4 armature = armaturePlace(tree, skin, root);
  std::vector<glm::dmat4> candidates{kIdentity, armature};
  for (std::size_t slot = 0; slot < skin.nodes.size(); ++slot) {
    if (!skin.carries_weight[slot]) continue;
    if (!isFlat(skin.world_from_mesh[slot])) candidates.push_back(skin.world_from_mesh[slot]);
    break;
  }
  // The simplest matrix that every joint agrees with; the identity leaves positions bit-exact.
  for (const glm::dmat4& candidate : candidates) {
    bool agrees = true;
    for (std::size_t slot = 0; slot < skin.nodes.size() && agrees; ++slot) {
      agrees = !skin.carries_weight[slot] || distance(skin.world_from_mesh[slot], candidate) <= kTolerance;
    }
    if (agrees) return candidate;
  }
  const glm::dmat4& of_root = skin.world_from_mesh[root];
  return distance(of_root, kIdentity) <= distance(of_root, armature) ? kIdentity : armature;
}

// joint_from_model of each slot under the skin's own B.
std::vector<glm::dmat4> jointsFromModel(const JsonRef& json, const GltfSkin& skin) {
  std::vector<glm::dmat4> result = skin.joint_from_mesh;
  if (skin.model_from_mesh == kIdentity) return result;
  if (isFlat(skin.model_from_mesh)) {
    json.fail("the skeleton's scale is 0", "apply the armature's transforms and export again");
  }
  const glm::dmat4 mesh_from_model = glm::inverse(skin.model_from_mesh);
  for (glm::dmat4& matrix : result) matrix = matrix * mesh_from_model;
  return result;
}

// Adds a skin's joints; joints that another skin has too must agree with it.
bool addJoints(const GltfDocument& document, std::size_t skin_index, GltfSkin& skin, GltfSkeleton& result) {
  const JsonRef json = document.item("skins", skin_index);
  const std::vector<glm::dmat4> joint_from_model = jointsFromModel(json, skin);
  bool agrees = true;
  for (std::size_t slot = 0; slot < skin.nodes.size(); ++slot) {
    const std::uint32_t node = skin.nodes[slot];
    const auto [entry, is_new] =
        result.joint_of_node.emplace(node, static_cast<std::uint16_t>(result.skeleton.joints.size()));
    if (is_new) {
      result.skeleton.joints.push_back({result.bone_of_node.at(node), Mat4(joint_from_model[slot])});
    } else if (skin.carries_weight[slot]) {
      const glm::dmat4 other(result.skeleton.joints[entry->second].joint_from_model);
      agrees = agrees && distance(joint_from_model[slot], other) <= 10.0 * kTolerance;
    }
    skin.joint_of_slot.push_back(entry->second);
  }
  if (result.skeleton.joints.size() > document.options().max_joints) {
    json.fail(fmt::format("more than the {} joints allowed", document.options().max_joints),
              "split the file");
  }
  return agrees;
}

// Where two skins were bound in different poses: every joint's bind pose becomes its rest.
void rebindAtRest(const GltfDocument& document, const GltfNodes& tree, GltfSkeleton& result) {
  result.rebound_at_rest = true;
  for (const auto& [node, joint] : result.joint_of_node) {
    const glm::dmat4& world = tree.nodes[node].world_from_node;
    if (isFlat(world)) document.item("nodes", node).fail("the joint's scale is 0");
    result.skeleton.joints[joint].joint_from_model = Mat4(glm::inverse(world));
  }
}

std::set<std::uint32_t> animatedNodes(const GltfDocument& document) {
  std::set<std::uint32_t> nodes;
  for (std::size_t i = 0; i < document.count("animations"); ++i) {
    const JsonRef channels = document.item("animations", i).require("channels");
    for (std::size_t c = 0; c < channels.size(); ++c) {
      if (const auto node = document.findIndex(channels[c].require("target"), "node", "nodes")) {
        nodes.insert(*node);
      }
    }
  }
  return nodes;
}

void moveVertex(const glm::dmat4& matrix, RawVertex& vertex) {
  const glm::dmat3 linear(matrix);
  // The cofactor matrix is the inverse transpose times the determinant, and always exists.
  glm::dmat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                      glm::cross(linear[0], linear[1]));
  if (glm::determinant(linear) < 0.0) cofactor = -cofactor;
  vertex.position = Vec3(glm::dvec3(matrix * glm::dvec4(glm::dvec3(vertex.position), 1.0)));
  const glm::dvec3 normal = cofactor * glm::dvec3(vertex.normal);
  const double length = glm::length(normal);
  vertex.normal = length > 0.0 ? Vec3(normal / length) : Vec3(0.0f);  // 0: to be made from the faces
}

// Applies one matrix; the identity leaves every bit as it is.
void movePrimitives(const glm::dmat4& matrix, RawMeshNode& mesh) {
  if (matrix == kIdentity) return;
  const bool mirrors = glm::determinant(glm::dmat3(matrix)) < 0.0;
  for (RawPrimitive& primitive : mesh.primitives) {
    for (RawVertex& vertex : primitive.vertices) moveVertex(matrix, vertex);
    if (!mirrors) continue;
    for (Triangle& face : primitive.faces) std::swap(face[1], face[2]);
  }
}

void moveByOwnJoints(const GltfSkin& skin, RawMeshNode& mesh) {
  for (RawPrimitive& primitive : mesh.primitives) {
    bool mirrors = false;
    for (RawVertex& vertex : primitive.vertices) {
      glm::dmat4 matrix(0.0);
      for (std::size_t i = 0; i < 4; ++i) {
        matrix += static_cast<double>(vertex.skin.weights[i]) * skin.world_from_mesh[vertex.skin.joints[i]];
      }
      mirrors = glm::determinant(glm::dmat3(matrix)) < 0.0;  // of the whole skin, in any sound file
      moveVertex(matrix, vertex);
    }
    if (!mirrors) continue;
    for (Triangle& face : primitive.faces) std::swap(face[1], face[2]);
  }
}

void nameJoints(const GltfSkin& skin, RawMeshNode& mesh) {
  for (RawPrimitive& primitive : mesh.primitives) {
    for (RawVertex& vertex : primitive.vertices) {
      for (std::size_t i = 0; i < 4; ++i) {
        std::uint16_t& joint = vertex.skin.joints[i];
        joint = vertex.skin.weights[i] > 0.0f ? skin.joint_of_slot[joint] : std::uint16_t{0};
      }
    }
  }
}

void bindToJoint(const GltfSkeleton& skeleton, const GltfNodes& tree, std::uint32_t node,
                 std::uint32_t joint_node, RawMeshNode& mesh) {
  const std::uint16_t joint = skeleton.joint_of_node.at(joint_node);
  const glm::dmat4 joint_from_model(skeleton.skeleton.joints[joint].joint_from_model);
  // At rest the joint moves model space by this; identity unless the file was saved in a pose.
  const glm::dmat4 world_from_model = tree.nodes[joint_node].world_from_node * joint_from_model;
  const glm::dmat4& world_from_node = tree.nodes[node].world_from_node;
  const bool is_rest = distance(world_from_model, kIdentity) <= kTolerance || isFlat(world_from_model);
  movePrimitives(is_rest ? world_from_node : glm::inverse(world_from_model) * world_from_node, mesh);
  for (RawPrimitive& primitive : mesh.primitives) {
    for (RawVertex& vertex : primitive.vertices) {
      vertex.skin = SkinBinding{{joint, 0, 0, 0}, {1.0f, 0.0f, 0.0f, 0.0f}};
    }
  }
}

}  // namespace

std::vector<GltfSkin> readSkins(const GltfDocument& document, const GltfNodes& tree) {
  std::vector<GltfSkin> skins;
  const std::size_t skin_count = document.count("skins");
  if (skin_count > document.options().max_joints) {
    document.root().require("skins").fail(
        fmt::format("{} skins are more than the {} allowed", skin_count, document.options().max_joints),
        "split the file");
  }
  for (std::size_t s = 0; s < skin_count; ++s) {
    const JsonRef json = document.item("skins", s);
    const JsonRef joints = json.require("joints");
    GltfSkin skin;
    if (joints.size() == 0) joints.fail("the skin has no joints");
    if (joints.size() > document.options().max_joints) {
      joints.fail(
          fmt::format("{} joints are more than the {} allowed", joints.size(), document.options().max_joints),
          "split the file");
    }
    std::set<std::uint32_t> seen;
    for (std::size_t slot = 0; slot < joints.size(); ++slot) {
      const std::uint32_t node = document.index(joints[slot], "nodes");
      if (!seen.insert(node).second) joints[slot].fail(fmt::format("node {} is a joint twice", node));
      skin.nodes.push_back(node);
    }
    skin.joint_from_mesh = readInverseBinds(document, json, skin.nodes.size());
    for (std::size_t slot = 0; slot < skin.nodes.size(); ++slot) {
      skin.world_from_mesh.push_back(tree.nodes[skin.nodes[slot]].world_from_node *
                                     skin.joint_from_mesh[slot]);
    }
    skin.carries_weight.assign(skin.nodes.size(), false);
    skins.push_back(std::move(skin));
  }
  for (const GltfNode& node : tree.nodes) {
    if (node.skin && node.mesh && node.in_scene) skins[*node.skin].used = true;
  }
  return skins;
}

GltfSkeleton joinSkins(const GltfDocument& document, const GltfNodes& tree, std::vector<GltfSkin> skins,
                       std::vector<std::string>& warnings) {
  GltfSkeleton result;
  result.skins = std::move(skins);
  // A skin without a mesh counts only in a file that has nothing else: a skeleton with clips.
  const bool any_used =
      std::any_of(result.skins.begin(), result.skins.end(), [](const GltfSkin& skin) { return skin.used; });
  std::set<std::uint32_t> wanted;
  for (const GltfSkin& skin : result.skins) {
    if (skin.used || !any_used) wanted.insert(skin.nodes.begin(), skin.nodes.end());
  }
  if (result.skins.empty()) wanted = animatedNodes(document);
  addBones(document, tree, wanted, result, warnings);
  bool agree = true;
  for (std::size_t s = 0; s < result.skins.size(); ++s) {
    GltfSkin& skin = result.skins[s];
    if (any_used && !skin.used) continue;
    skin.model_from_mesh = settleModelFromMesh(tree, skin);
    agree = addJoints(document, s, skin, result) && agree;
  }
  std::set<std::uint32_t> joints;
  for (const auto& [node, joint] : result.joint_of_node) joints.insert(node);
  result.nearest_joint = nearestOf(tree, joints);
  if (!agree) {
    rebindAtRest(document, tree, result);
    warnings.push_back("the file's skins were bound in different poses; all are bound anew at rest");
  }
  return result;
}

void moveToModelSpace(const GltfSkeleton& skeleton, const GltfNodes& tree, std::uint32_t node,
                      RawMeshNode& mesh) {
  if (tree.nodes[node].skin) {
    const GltfSkin& skin = skeleton.skins[*tree.nodes[node].skin];
    if (skeleton.rebound_at_rest) {
      moveByOwnJoints(skin, mesh);
    } else {
      movePrimitives(skin.model_from_mesh, mesh);
    }
    nameJoints(skin, mesh);
    return;
  }
  const std::int32_t joint_node = skeleton.nearest_joint[node];
  mesh.skinned = joint_node >= 0;
  if (mesh.skinned) {
    bindToJoint(skeleton, tree, node, static_cast<std::uint32_t>(joint_node), mesh);
  } else {
    movePrimitives(tree.nodes[node].world_from_node, mesh);
  }
}

}  // namespace ensemble
