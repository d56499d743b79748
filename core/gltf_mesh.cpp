// glTF 2.0, section 3.7.2 (meshes); KHR_mesh_quantization; KHR_draco_mesh_compression.
#include "core/gltf_mesh.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "core/collapse.h"
#include "core/gltf_accessor.h"
#include "core/gltf_draco.h"
#include "core/gltf_weld.h"

namespace ensemble {
namespace {

constexpr int kMaxInfluenceSets = 16;  // JOINTS_0 to JOINTS_15

enum class Topology { kTriangles = 4, kStrip = 5, kFan = 6 };

/// Where a primitive's numbers come from: accessors, or Draco data for those that it compresses.
class PrimitiveSource {
 public:
  PrimitiveSource(const GltfDocument& document, const JsonRef& primitive, std::uint64_t max_vertices,
                  std::uint64_t max_faces)
      : document_(document), primitive_(primitive), attributes_(primitive.require("attributes")) {
    vertex_count_ = describe("POSITION").count;
    limit(vertex_count_, max_vertices, "vertices");
    if (const auto extensions = primitive.find("extensions")) {
      if (const auto draco = extensions->find("KHR_draco_mesh_compression")) openDraco(*draco, max_faces);
    }
    if (!draco_) requireBytes(accessorIndex("POSITION"), vertex_count_, "vertices");
  }

  bool has(const std::string& name) const { return attributes_.has(name); }
  std::uint64_t vertexCount() const { return vertex_count_; }
  const JsonRef& attributes() const { return attributes_; }
  JsonRef attribute(const std::string& name) const { return attributes_.require(name); }

  std::vector<float> floats(const std::string& name, std::uint32_t components) const {
    const GltfAccessor accessor = describe(name);
    checkShape(name, accessor, components);
    if (const auto id = dracoId(name)) return draco_->floats(*id, accessor);
    return readFloats(document_, accessorIndex(name), components);
  }

  std::vector<std::uint32_t> unsignedIntegers(const std::string& name, std::uint32_t components) const {
    const GltfAccessor accessor = describe(name);
    checkShape(name, accessor, components);
    if (const auto id = dracoId(name)) return draco_->unsignedIntegers(*id, accessor);
    return readUnsigned(document_, accessorIndex(name), components);
  }

  /// Corner indices, each in range, as many as the topology says.
  std::vector<std::uint32_t> indices(std::uint64_t max_faces) const {
    std::vector<std::uint32_t> result;
    if (draco_) {
      result = draco_->indices();
    } else if (const auto accessor = document_.findIndex(primitive_, "indices", "accessors")) {
      const std::uint64_t count = describeAccessor(document_, *accessor).count;
      limit(count, 3 * max_faces, "indices");
      requireBytes(*accessor, count, "indices");
      result = readUnsigned(document_, *accessor, 1);
    } else {
      limit(vertex_count_, 3 * max_faces, "vertices without indices");
      result.resize(vertex_count_);
      for (std::uint32_t i = 0; i < result.size(); ++i) result[i] = i;
    }
    for (std::size_t i = 0; i < result.size(); ++i) {
      if (result[i] >= vertex_count_) {
        primitive_.require("indices").fail(fmt::format(
            "index {} at {} is not below the number of vertices, {}", result[i], i, vertex_count_));
      }
    }
    return result;
  }

 private:
  void openDraco(const JsonRef& draco, std::uint64_t max_faces) {
    const auto indices = document_.findIndex(primitive_, "indices", "accessors");
    const std::uint64_t index_count = indices ? describeAccessor(document_, *indices).count : 3 * max_faces;
    limit(index_count, 3 * max_faces, "indices");
    draco_attributes_ = draco.require("attributes");
    const std::uint32_t view = document_.index(draco.require("bufferView"), "bufferViews");
    draco_.emplace(draco, document_.view(view).bytes, index_count / 3, vertex_count_);
    if (draco_->vertexCount() != vertex_count_) {
      draco.fail(fmt::format("the Draco data hold {} vertices, the accessors {}", draco_->vertexCount(),
                             vertex_count_));
    }
  }

  /// An accessor without bufferView is of zeros: a few bytes of file that cost gigabytes when read.
  void requireBytes(std::uint32_t accessor, std::uint64_t count, const char* what) const {
    constexpr std::uint64_t kMostWithout = 1u << 16;
    if (count <= kMostWithout || document_.item("accessors", accessor).has("bufferView")) return;
    primitive_.fail(fmt::format("{} {} have no bufferView", count, what));
  }

  void limit(std::uint64_t count, std::uint64_t most, const char* what) const {
    if (count > most) {
      primitive_.fail(fmt::format("{} {} are more than the {} still allowed in this file", count, what, most),
                      "split the file");
    }
  }

  std::uint32_t accessorIndex(const std::string& name) const {
    return document_.index(attributes_.require(name), "accessors");
  }
  GltfAccessor describe(const std::string& name) const {
    return describeAccessor(document_, accessorIndex(name));
  }

  void checkShape(const std::string& name, const GltfAccessor& accessor, std::uint32_t components) const {
    if (accessor.count != vertex_count_) {
      attribute(name).fail(fmt::format("{} {} for {} positions", accessor.count, name, vertex_count_));
    }
    if (accessor.components != components) {
      attribute(name).fail(
          fmt::format("{} has {} components instead of {}", name, accessor.components, components));
    }
  }

  std::optional<JsonRef> dracoId(const std::string& name) const {
    return draco_attributes_ ? draco_attributes_->find(name) : std::nullopt;
  }

  const GltfDocument& document_;
  JsonRef primitive_, attributes_;
  std::uint64_t vertex_count_ = 0;
  std::optional<JsonRef> draco_attributes_;
  std::optional<DracoMesh> draco_;
};

std::vector<Triangle> makeFaces(const std::vector<std::uint32_t>& indices, Topology topology) {
  std::vector<Triangle> faces;
  if (topology == Topology::kTriangles) {
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      faces.push_back({indices[i], indices[i + 1], indices[i + 2]});
    }
    return faces;
  }
  for (std::size_t i = 0; i + 2 < indices.size(); ++i) {
    Triangle face{indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]};
    if (topology == Topology::kFan) face = {indices[i + 1], indices[i + 2], indices[0]};
    // Strips are stitched with triangles that name a vertex twice.
    if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0]) faces.push_back(face);
  }
  return faces;
}

void readUvs(const PrimitiveSource& source, const GltfMaterial& material, std::vector<RawVertex>& vertices) {
  const std::string name = fmt::format("TEXCOORD_{}", material.image ? material.uv_set : 0);
  if (!source.has(name)) return;
  const std::vector<float> numbers = source.floats(name, 2);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices[i].uv = Vec2(numbers[i * 2], numbers[i * 2 + 1]);
    if (material.image && material.uv_transform != Mat3(1.0f)) {
      vertices[i].uv = Vec2(material.uv_transform * Vec3(vertices[i].uv, 1.0f));
    }
  }
}

void readTemplateVertices(const PrimitiveSource& source, RawPrimitive& primitive) {
  if (!source.has("_TEMPLATE_VERTEX")) return;
  for (const float number : source.floats("_TEMPLATE_VERTEX", 1)) {
    if (number < 0.0f || number > 16777216.0f || std::floor(number) != number) {
      source.attribute("_TEMPLATE_VERTEX")
          .fail(fmt::format("{} is no vertex number", number), "tag the outfit again");
    }
    primitive.template_vertices.push_back(static_cast<std::uint32_t>(number));
  }
}

void readCollapses(const PrimitiveSource& source, RawPrimitive& primitive) {
  if (!source.has("_COLLAPSE")) return;
  const std::vector<float> numbers = source.floats("_COLLAPSE", 2);
  for (std::size_t i = 0; i < primitive.vertices.size(); ++i) {
    const float target = numbers[i * 2], level = numbers[i * 2 + 1];
    const bool is_whole = std::floor(target) == target && std::floor(level) == level;
    if (!is_whole || target < 0.0f || target > 16777216.0f || level < 0.0f || level > 255.0f) {
      source.attribute("_COLLAPSE")
          .fail(fmt::format("vertex {} can't go to {} at level {}", i, target, level),
                "tag the outfit again");
    }
    primitive.collapses.push_back({static_cast<std::uint32_t>(target), static_cast<std::uint8_t>(level)});
  }
  if (!areValid(primitive.collapses))
    source.attribute("_COLLAPSE")
        .fail("a vertex goes to one that does not outlast it", "tag the outfit again");
}

void readHide(const PrimitiveSource& source, RawPrimitive& primitive) {
  if (source.has("_HIDE")) primitive.hide = source.floats("_HIDE", 1);
}

/// The influences of all vertices of a primitive, JOINTS_0 and on.
struct Influences {
  std::vector<std::vector<std::uint32_t>> joints;
  std::vector<std::vector<float>> weights;
};

Influences readInfluences(const PrimitiveSource& source, const JsonRef& primitive) {
  Influences result;
  for (int set = 0;; ++set) {
    const std::string joints = fmt::format("JOINTS_{}", set), weights = fmt::format("WEIGHTS_{}", set);
    if (source.has(joints) != source.has(weights)) {
      primitive.fail(fmt::format("the primitive has only one of {} and {}", joints, weights));
    }
    if (!source.has(joints)) break;
    if (set == kMaxInfluenceSets)
      primitive.fail("a vertex has more than 64 influences", "limit them to four");
    result.joints.push_back(source.unsignedIntegers(joints, 4));
    result.weights.push_back(source.floats(weights, 4));
  }
  if (result.joints.empty()) {
    primitive.fail("the mesh has a skin, but the primitive has no JOINTS_0 and WEIGHTS_0",
                   "bind every vertex to a joint and export again");
  }
  return result;
}

std::vector<std::pair<std::uint32_t, float>> influencesOf(const Influences& all, std::size_t vertex,
                                                          const GltfSkin& skin, const JsonRef& primitive) {
  std::vector<std::pair<std::uint32_t, float>> result;
  for (std::size_t set = 0; set < all.joints.size(); ++set) {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t joint = all.joints[set][vertex * 4 + i];
      const float weight = all.weights[set][vertex * 4 + i];
      if (weight < -1e-4f) {
        primitive.fail(fmt::format("vertex {} has the negative weight {}", vertex, weight),
                       "normalise the weights and export again");
      }
      if (weight <= 0.0f) continue;
      if (joint >= skin.nodes.size()) {
        primitive.fail(fmt::format("vertex {} names joint {} of {}", vertex, joint, skin.nodes.size()));
      }
      result.emplace_back(joint, weight);
    }
  }
  return result;
}

// Returns how many vertices had more than four influences.
std::size_t readBindings(const PrimitiveSource& source, const JsonRef& json, GltfSkin& skin,
                         std::vector<RawVertex>& vertices) {
  std::size_t reduced = 0;
  const Influences all = readInfluences(source, json);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const auto influences = influencesOf(all, i, skin, json);
    if (influences.size() > 4) ++reduced;
    vertices[i].skin = settleBinding(influences);
    if (vertices[i].skin.weights[0] <= 0.0f) {
      json.fail(fmt::format("vertex {} has no weight: its weights sum to zero", i),
                "bind the vertex to a joint and export again");
    }
    for (std::size_t k = 0; k < 4; ++k) {
      if (vertices[i].skin.weights[k] > 0.0f) skin.carries_weight[vertices[i].skin.joints[k]] = true;
    }
  }
  return reduced;
}

void noteDropped(const PrimitiveSource& source, const JsonRef& json, const std::string& node,
                 DroppedList& dropped) {
  for (const auto& [name, value] : source.attributes().json().items()) {
    if (name == "TANGENT") {
      dropped.add("tangents");
    } else if (name.starts_with("COLOR_")) {
      dropped.add(fmt::format("vertex colours of node '{}'", node));
    } else if (name.starts_with("_") && name != "_TEMPLATE_VERTEX" && name != "_HIDE" &&
               name != "_COLLAPSE") {
      dropped.add(fmt::format("attribute '{}'", name));
    }
  }
  if (json.has("targets")) dropped.add(fmt::format("morph targets of node '{}'", node));
}

std::optional<Topology> readTopology(const JsonRef& json) {
  const std::uint64_t mode = json.wholeNumberOr("mode", 4, 6);
  if (mode < 4) return std::nullopt;
  return static_cast<Topology>(mode);
}

void readVertices(const PrimitiveSource& source, const GltfMaterial& material, RawPrimitive& primitive) {
  primitive.vertices.resize(source.vertexCount());
  const std::vector<float> positions = source.floats("POSITION", 3);
  std::vector<float> normals(positions.size(), 0.0f);
  if (source.has("NORMAL")) normals = source.floats("NORMAL", 3);
  for (std::size_t i = 0; i < primitive.vertices.size(); ++i) {
    primitive.vertices[i].position = Vec3(positions[i * 3], positions[i * 3 + 1], positions[i * 3 + 2]);
    primitive.vertices[i].normal = Vec3(normals[i * 3], normals[i * 3 + 1], normals[i * 3 + 2]);
  }
  readUvs(source, material, primitive.vertices);
  readTemplateVertices(source, primitive);
  readHide(source, primitive);
  readCollapses(source, primitive);
}

}  // namespace

RawMeshNode MeshReading::readMeshNode(std::uint32_t node_index) {
  const GltfNode& node = tree.nodes[node_index];
  const JsonRef mesh_json = document.item("meshes", *node.mesh);
  RawMeshNode mesh;
  mesh.name = node.name.empty() ? mesh_json.stringOr("name", "") : node.name;
  if (mesh.name.empty()) mesh.name = node.label(node_index);
  mesh.json_pointer = fmt::format("/nodes/{}", node_index);
  const JsonRef primitives = mesh_json.require("primitives");
  std::size_t reduced = 0;
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    const JsonRef json = primitives[p];
    const auto topology = readTopology(json);
    if (!topology) {
      dropped.add(fmt::format("points and lines of node '{}'", mesh.name));
      continue;
    }
    const PrimitiveSource source(document, json, vertices_left, faces_left);
    RawPrimitive primitive;
    const auto material = document.findIndex(json, "material", "materials");
    primitive.material = material.value_or(static_cast<std::uint32_t>(materials.size() - 1));
    primitive.faces = makeFaces(source.indices(faces_left), *topology);
    if (primitive.faces.size() > faces_left) json.fail("the file has too many faces", "split the file");
    readVertices(source, materials[primitive.material], primitive);
    if (node.skin) reduced += readBindings(source, json, skins[*node.skin], primitive.vertices);
    noteDropped(source, json, mesh.name, dropped);
    vertices_left -= primitive.vertices.size();
    faces_left -= primitive.faces.size();
    if (!primitive.faces.empty()) mesh.primitives.push_back(std::move(primitive));
  }
  if (reduced > 0) {
    warnings.push_back(
        fmt::format("node '{}': {} vertices have more than four influences; the four largest "
                    "are kept",
                    mesh.name, reduced));
  }
  return mesh;
}

}  // namespace ensemble
