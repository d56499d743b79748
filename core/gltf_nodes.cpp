// glTF 2.0, sections 3.5.2 (nodes and hierarchy) and 3.5.3 (transformations).
#include "core/gltf_nodes.h"

#include <fmt/format.h>

#include <cmath>

namespace ensemble {
namespace {

Vec3 toVec3(const std::vector<double>& numbers) {
  return Vec3(static_cast<float>(numbers[0]), static_cast<float>(numbers[1]), static_cast<float>(numbers[2]));
}

Quat readRotation(const JsonRef& ref) {
  const std::vector<double> xyzw = ref.numbers(4);
  const glm::dquat rotation(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  const double length = glm::length(rotation);
  if (!(length > 1e-6 && length < 1e6)) ref.fail("the rotation is no unit quaternion");
  // Float noise stays as it is, so that what we wrote is read back bit for bit.
  return Quat(std::abs(length - 1.0) < 1e-5 ? rotation : rotation / length);
}

void readMatrix(const JsonRef& ref, GltfNode& node) {
  const std::vector<double> numbers = ref.numbers(16);
  glm::dmat4 matrix(1.0);
  for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = numbers[static_cast<std::size_t>(i)];
  const glm::dvec4 last_row(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3] - 1.0);
  if (glm::length(last_row) > 1e-5) ref.fail("the matrix is not affine: its last row must be 0 0 0 1");
  for (int column = 0; column < 4; ++column) matrix[column][3] = column == 3 ? 1.0 : 0.0;
  node.local = toTransform(Mat4(matrix));
  node.world_from_node = matrix;  // of this node alone, until placeNodes
  const glm::dmat4 difference = matrix - toMatrixDouble(node.local);
  double error = 0.0, size = 0.0;
  for (int column = 0; column < 3; ++column) {
    error += glm::length(difference[column]);
    size += glm::length(matrix[column]);
  }
  node.has_shear = error > 1e-4 * size;
}

GltfNode readNode(const GltfDocument& document, const JsonRef& json) {
  GltfNode node;
  node.name = json.stringOr("name", "");
  node.mesh = document.findIndex(json, "mesh", "meshes");
  node.skin = document.findIndex(json, "skin", "skins");
  if (const auto children = json.find("children")) {
    for (std::size_t i = 0; i < children->size(); ++i) {
      node.children.push_back(document.index((*children)[i], "nodes"));
    }
  }
  if (const auto matrix = json.find("matrix")) {
    readMatrix(*matrix, node);
    return node;
  }
  if (const auto t = json.find("translation")) node.local.translation = toVec3(t->numbers(3));
  if (const auto r = json.find("rotation")) node.local.rotation = readRotation(*r);
  if (const auto s = json.find("scale")) node.local.scale = toVec3(s->numbers(3));
  node.world_from_node = toMatrixDouble(node.local);
  return node;
}

void linkParents(const GltfDocument& document, std::vector<GltfNode>& nodes) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const std::uint32_t child : nodes[i].children) {
      if (nodes[child].parent >= 0) {
        document.item("nodes", child)
            .fail(fmt::format("the node has two parents, {} and {}", nodes[child].parent, i));
      }
      nodes[child].parent = static_cast<std::int32_t>(i);
    }
  }
}

// Breadth first from the roots. Whoever is not reached stands in a cycle.
void placeNodes(const GltfDocument& document, GltfNodes& tree) {
  std::vector<GltfNode>& nodes = tree.nodes;
  std::vector<bool> reached(nodes.size(), false);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].parent < 0) tree.parents_first.push_back(static_cast<std::uint32_t>(i));
  }
  for (std::size_t next = 0; next < tree.parents_first.size(); ++next) {
    const std::uint32_t index = tree.parents_first[next];
    GltfNode& node = nodes[index];
    reached[index] = true;
    if (node.parent >= 0) {
      node.world_from_node =
          nodes[static_cast<std::size_t>(node.parent)].world_from_node * node.world_from_node;
    }
    for (int column = 0; column < 4; ++column) {
      if (!std::isfinite(glm::dot(node.world_from_node[column], glm::dvec4(1.0)))) {
        document.item("nodes", index).fail("the node's place in the world is not finite");
      }
    }
    tree.parents_first.insert(tree.parents_first.end(), node.children.begin(), node.children.end());
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!reached[i]) document.item("nodes", i).fail("the node is its own ancestor");
  }
}

void markScene(const GltfDocument& document, GltfNodes& tree) {
  std::vector<GltfNode>& nodes = tree.nodes;
  const std::size_t scene_count = document.count("scenes");
  const auto scene = document.findIndex(document.root(), "scene", "scenes");
  if (scene_count == 0) {
    for (GltfNode& node : nodes) node.in_scene = true;
    return;
  }
  if (const auto roots = document.item("scenes", scene.value_or(0)).find("nodes")) {
    for (std::size_t i = 0; i < roots->size(); ++i) {
      const std::uint32_t root = document.index((*roots)[i], "nodes");
      if (nodes[root].parent >= 0) (*roots)[i].fail(fmt::format("node {} is no root", root));
      nodes[root].in_scene = true;
    }
  }
  for (const std::uint32_t index : tree.parents_first) {
    GltfNode& node = nodes[index];
    if (node.parent >= 0) node.in_scene = nodes[static_cast<std::size_t>(node.parent)].in_scene;
  }
}

}  // namespace

std::string GltfNode::label(std::size_t index) const {
  return name.empty() ? fmt::format("node {}", index) : name;
}

glm::dmat4 toMatrixDouble(const Transform& transform) {
  const glm::dmat3 rotation = glm::mat3_cast(glm::dquat(transform.rotation));
  const glm::dvec3 scale(transform.scale);
  return glm::dmat4(glm::dvec4(rotation[0] * scale.x, 0.0), glm::dvec4(rotation[1] * scale.y, 0.0),
                    glm::dvec4(rotation[2] * scale.z, 0.0),
                    glm::dvec4(glm::dvec3(transform.translation), 1.0));
}

GltfNodes readNodes(const GltfDocument& document) {
  GltfNodes tree;
  const std::size_t node_count = document.count("nodes");
  if (node_count > document.options().max_nodes) {
    document.root().require("nodes").fail(
        fmt::format("{} nodes are more than the {} allowed", node_count, document.options().max_nodes),
        "split the file");
  }
  for (std::size_t i = 0; i < node_count; ++i) {
    tree.nodes.push_back(readNode(document, document.item("nodes", i)));
  }
  linkParents(document, tree.nodes);
  placeNodes(document, tree);
  markScene(document, tree);
  return tree;
}

}  // namespace ensemble
