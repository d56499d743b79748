// Sub-mesh lists of the three techniques compared by Lister, Laycock and Day, "Geometric Diversity
// for Crowds on the GPU", section 3.1: naive (3.1.1), pre-fitted (3.1.2) and tagged (3.1.3).
#include "core/sub_mesh_lists.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>

#include "core/check.h"
#include "core/hash.h"

namespace ensemble {
namespace {

constexpr std::size_t kMaxNarrowVertices = 65536;

std::uint16_t toUnorm16(float value) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 65535.0f));
}

std::int16_t toSnorm16(float value) {
  return static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0f, 1.0f) * 32767.0f));
}

/// Octahedral coordinates of a unit vector (Meyer et al. 2010); shaders/shared/vertex.h decodes.
Vec2 encodeOctahedral(Vec3 normal) {
  const float sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
  if (!(sum > 0.0f)) return {0.0f, 0.0f};
  normal /= sum;
  if (normal.z >= 0.0f) return {normal.x, normal.y};
  return {(1.0f - std::abs(normal.y)) * (normal.x >= 0.0f ? 1.0f : -1.0f),
          (1.0f - std::abs(normal.x)) * (normal.y >= 0.0f ? 1.0f : -1.0f)};
}

/// Numbers of the faces in an order that reuses vertices soon. Meshoptimizer reorders triangles but
/// keeps their corners, so each is found again by them; equal triangles keep their order.
std::vector<std::uint32_t> vertexCacheOrder(std::span<const Triangle> faces, std::size_t vertex_count) {
  if (faces.empty()) return {};
  std::vector<std::uint32_t> ordered(faces.size() * 3);
  meshopt_optimizeVertexCache(ordered.data(), faces.front().data(), ordered.size(), vertex_count);

  std::vector<std::uint32_t> by_corners(faces.size());
  std::iota(by_corners.begin(), by_corners.end(), 0u);
  std::stable_sort(by_corners.begin(), by_corners.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return faces[a] < faces[b]; });
  std::map<Triangle, std::size_t> taken;
  std::vector<std::uint32_t> order(faces.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Triangle corners{ordered[3 * i], ordered[3 * i + 1], ordered[3 * i + 2]};
    const auto first = std::lower_bound(by_corners.begin(), by_corners.end(), corners,
                                        [&](std::uint32_t a, const Triangle& b) { return faces[a] < b; });
    order[i] = *(first + static_cast<std::ptrdiff_t>(taken[corners]++));
  }
  return order;
}

std::span<const std::byte> bytesOf(const auto& vector) { return std::as_bytes(std::span(vector)); }

/// Collects distinct things by content.
class ListsBuilder {
 public:
  ListsBuilder(const Wardrobe& wardrobe, std::span<const Combination> combinations, Technique technique)
      : wardrobe_(wardrobe), body_(wardrobe.body) {
    lists_.technique = technique;
    lists_.combinations.assign(combinations.begin(), combinations.end());
    lists_.shown.resize(combinations.size());
  }

  SubMeshLists build() {
    orderTemplateFaces();
    findVisibleFaces();
    for (std::size_t c = 0; c < visible_.size(); ++c) addGarments(c);
    for (std::size_t c = 0; c < visible_.size(); ++c) addExtraBody(c);
    if (lists_.technique == Technique::kPrefitted) {
      addPrefittedBodies();
    } else {
      addTemplate();
    }
    sortSubMeshes();
    return std::move(lists_);
  }

 private:
  using VisibleFaces = std::vector<std::uint8_t>;  ///< per template face

  /// One order of the template's faces that every list is a subsequence of: parts one after the
  /// other, vertex-cache order inside each.
  void orderTemplateFaces() {
    for (const BodyPart& part : body_.parts) {
      const std::span faces(body_.faces.raw().data() + part.first_face, part.face_count);
      std::vector<std::uint32_t> order = vertexCacheOrder(faces, body_.vertices.size());
      for (std::uint32_t& face : order) face += part.first_face;
      part_order_.push_back(std::move(order));
    }
  }

  void findVisibleFaces() {
    for (const Combination& combination : lists_.combinations) {
      VisibleFaces visible(body_.faces.size(), 1);
      for (const ItemId item : combination) {
        const auto& under_item = wardrobe_.items[item].visible.raw();
        ENSEMBLE_CHECK(under_item.size() == visible.size());
        for (std::size_t face = 0; face < visible.size(); ++face) visible[face] &= under_item[face];
      }
      std::vector<std::uint32_t> hidden((visible.size() + 31) / 32);
      for (std::size_t face = 0; face < visible.size(); ++face) {
        if (visible[face] == 0) hidden[face / 32] |= 1u << (face % 32);
      }
      lists_.hidden_bits.push_back(std::move(hidden));
      visible_.push_back(std::move(visible));
    }
  }

  void addGarments(std::size_t combination) {
    for (const ItemId item_id : lists_.combinations[combination]) {
      const Item& item = wardrobe_.items[item_id];
      for (const Garment& garment : item.garments) {
        std::uint32_t face_offset = 0;
        for (const ItemPart& part : garment.parts) {
          if (!part.faces.empty()) {
            SubMesh sub_mesh{SubMeshKind::kGarment, addPart(part),
                             addMaterial(item.materials[part.material], item.images, false),
                             addGarmentName(garment.name), face_offset};
            show(combination, sub_mesh, 0);
          }
          face_offset += static_cast<std::uint32_t>(part.faces.size());
        }
      }
    }
  }

  /// Body faces that only this outfit has are its geometry in every technique. Their numbers follow
  /// the template's.
  void addExtraBody(std::size_t combination) {
    for (const ItemId item_id : lists_.combinations[combination]) {
      const Item& item = wardrobe_.items[item_id];
      auto face_offset = static_cast<std::uint32_t>(body_.faces.size());
      for (const ExtraBodyPart& extra : item.extra_body) {
        if (extra.part.faces.empty()) continue;
        SubMesh sub_mesh{SubMeshKind::kBody, addPart(extra.part),
                         addMaterial(item.materials[extra.part.material], item.images, true),
                         extra.region.value, face_offset};
        show(combination, sub_mesh, 1);
        face_offset += static_cast<std::uint32_t>(extra.part.faces.size());
      }
    }
  }

  /// A part of an item becomes a mesh of its own, in vertex-cache order, renumbered by first use.
  IndexListId addPart(const ItemPart& part) {
    IndexList list;
    list.source_faces = vertexCacheOrder(part.faces, part.vertices.size());
    Mesh mesh = takeVertices(part.vertices, part.faces, list.source_faces, list.indices);
    list.mesh = addMesh(std::move(mesh), list.indices);
    return addList(std::move(list));
  }

  /// The vertices that some faces use, in order of first use, and the faces' indices into them.
  static Mesh takeVertices(std::span<const RawVertex> vertices, std::span<const Triangle> faces,
                           std::span<const std::uint32_t> face_order, std::vector<std::uint32_t>& indices) {
    constexpr std::uint32_t kUnused = 0xffffffffu;
    std::vector<std::uint32_t> renumbered(vertices.size(), kUnused);
    Mesh mesh;
    for (const std::uint32_t face : face_order) {
      for (const std::uint32_t vertex : faces[face]) {
        if (renumbered[vertex] == kUnused) {
          renumbered[vertex] = static_cast<std::uint32_t>(mesh.vertices.size());
          mesh.vertices.push_back(packVertex(vertices[vertex]));
        }
        indices.push_back(renumbered[vertex]);
      }
    }
    mesh.wide_indices = mesh.vertices.size() > kMaxNarrowVertices;
    return mesh;
  }

  /// naive and tagged: the template once, a generic list per part; tagged: a dedicated list where a
  /// combination shows some of a part's faces only.
  void addTemplate() {
    std::vector<std::uint32_t> all_indices, all_faces;
    for (const auto& order : part_order_) all_faces.insert(all_faces.end(), order.begin(), order.end());
    Mesh mesh = takeVertices(body_.vertices.raw(), body_.faces.raw(), all_faces, all_indices);
    std::vector<Triangle> corners(body_.faces.size());  // by FaceId, in the mesh's numbers
    for (std::size_t i = 0; i < all_faces.size(); ++i) {
      corners[all_faces[i]] = {all_indices[3 * i], all_indices[3 * i + 1], all_indices[3 * i + 2]};
    }
    const MeshId mesh_id = addMesh(std::move(mesh), all_indices);

    const VisibleFaces everything(body_.faces.size(), 1);
    for (std::size_t p = 0; p < body_.parts.size(); ++p) {
      const IndexListId generic = addTemplateList(mesh_id, p, everything, corners);
      for (std::size_t c = 0; c < visible_.size(); ++c) {
        const bool tagged = lists_.technique == Technique::kTagged;
        const IndexListId list = tagged ? addTemplateList(mesh_id, p, visible_[c], corners) : generic;
        showBodyPart(c, p, list);
      }
    }
  }

  /// pre-fitted: every distinct visible body owns its vertices, compacted.
  void addPrefittedBodies() {
    std::map<std::string, std::pair<MeshId, std::vector<Triangle>>> bodies;
    for (std::size_t c = 0; c < visible_.size(); ++c) {
      const std::string key = sha256Hex(bytesOf(visible_[c]));
      auto found = bodies.find(key);
      if (found == bodies.end()) {
        std::vector<std::uint32_t> faces, indices;
        for (const auto& order : part_order_) {
          std::copy_if(order.begin(), order.end(), std::back_inserter(faces),
                       [&](std::uint32_t face) { return visible_[c][face] != 0; });
        }
        if (faces.empty()) continue;
        Mesh mesh = takeVertices(body_.vertices.raw(), body_.faces.raw(), faces, indices);
        std::vector<Triangle> corners(body_.faces.size());
        for (std::size_t i = 0; i < faces.size(); ++i) {
          corners[faces[i]] = {indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]};
        }
        const MeshId mesh_id = addMesh(std::move(mesh), indices);
        found = bodies.emplace(key, std::pair(mesh_id, std::move(corners))).first;
      }
      const auto& [mesh_id, corners] = found->second;
      for (std::size_t p = 0; p < body_.parts.size(); ++p) {
        showBodyPart(c, p, addTemplateList(mesh_id, p, visible_[c], corners));
      }
    }
  }

  /// The visible faces of a part as a list into a mesh; none() where there are none.
  IndexListId addTemplateList(MeshId mesh, std::size_t part, const VisibleFaces& visible,
                              std::span<const Triangle> corners) {
    IndexList list;
    list.mesh = mesh;
    list.is_template = true;
    for (const std::uint32_t face : part_order_[part]) {
      if (visible[face] == 0) continue;
      list.source_faces.push_back(face);
      list.indices.insert(list.indices.end(), corners[face].begin(), corners[face].end());
    }
    return list.indices.empty() ? IndexListId::none() : addList(std::move(list));
  }

  void showBodyPart(std::size_t combination, std::size_t part, IndexListId list) {
    if (!list.valid()) return;
    const std::uint32_t material =
        addMaterial(body_.materials[body_.parts[part].material], body_.images, true);
    show(combination, SubMesh{SubMeshKind::kBody, list, material, body_.parts[part].region.value, 0},
         static_cast<std::uint32_t>(2 + part));
  }

  /// Content decides whether a mesh is new: its vertices, and the faces that use all of them.
  MeshId addMesh(Mesh mesh, std::span<const std::uint32_t> indices) {
    const std::string key = Sha256().feed(bytesOf(mesh.vertices)).feed(std::as_bytes(indices)).hex();
    const auto [entry, is_new] = mesh_by_content_.try_emplace(key, MeshId(lists_.meshes.size()));
    if (is_new) lists_.meshes.push(std::move(mesh));
    return entry->second;
  }

  IndexListId addList(IndexList list) {
    const std::string key = Sha256()
                                .feedValue(list.mesh.value)
                                .feedValue(list.is_template)
                                .feed(bytesOf(list.indices))
                                .feed(bytesOf(list.source_faces))
                                .hex();
    const auto [entry, is_new] = list_by_content_.try_emplace(key, IndexListId(lists_.index_lists.size()));
    if (is_new) lists_.index_lists.push(std::move(list));
    return entry->second;
  }

  std::uint32_t addMaterial(RawMaterial material, const std::vector<RawImage>& images, bool is_skin) {
    if (material.image) material.image = addImage(images[*material.image]);
    for (std::size_t i = 0; i < lists_.materials.size(); ++i) {
      if (lists_.materials[i].is_skin == is_skin && lists_.materials[i].material == material) {
        return static_cast<std::uint32_t>(i);
      }
    }
    lists_.materials.push_back({std::move(material), is_skin});
    return static_cast<std::uint32_t>(lists_.materials.size() - 1);
  }

  std::uint32_t addImage(const RawImage& image) {
    const auto next = static_cast<std::uint32_t>(lists_.images.size());
    const auto [entry, is_new] = image_by_content_.try_emplace(sha256Hex(image.bytes), next);
    if (is_new) lists_.images.push_back(image);
    return entry->second;
  }

  std::uint32_t addGarmentName(const std::string& name) {
    const auto found = std::find(lists_.garment_names.begin(), lists_.garment_names.end(), name);
    if (found == lists_.garment_names.end()) lists_.garment_names.push_back(name);
    return static_cast<std::uint32_t>(
        std::find(lists_.garment_names.begin(), lists_.garment_names.end(), name) -
        lists_.garment_names.begin());
  }

  /// Lets a combination show a sub-mesh. `rank` says when it is drawn: garments, extra body faces,
  /// then the template's parts, so that all techniques draw a character's faces in one order.
  void show(std::size_t combination, const SubMesh& sub_mesh, std::uint32_t rank) {
    const std::array<std::uint32_t, 5> key{sub_mesh.list.value, sub_mesh.material, sub_mesh.region,
                                           sub_mesh.source_face_offset,
                                           static_cast<std::uint32_t>(sub_mesh.kind)};
    const auto [entry, is_new] = sub_mesh_by_content_.try_emplace(key, SubMeshId(lists_.sub_meshes.size()));
    if (is_new) {
      lists_.sub_meshes.push(sub_mesh);
      rank_.push_back(rank);
    }
    auto& shown = lists_.shown[combination];
    if (std::find(shown.begin(), shown.end(), entry->second) == shown.end()) shown.push_back(entry->second);
  }

  /// Numbers sub-meshes in draw order.
  void sortSubMeshes() {
    std::vector<std::uint32_t> order(lists_.sub_meshes.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return rank_[a] < rank_[b]; });
    std::vector<SubMeshId> renumbered(order.size());
    PerId<SubMeshId, SubMesh> sorted;
    for (const std::uint32_t old : order) renumbered[old] = sorted.push(lists_.sub_meshes[SubMeshId(old)]);
    lists_.sub_meshes = std::move(sorted);
    for (auto& shown : lists_.shown) {
      for (SubMeshId& id : shown) id = renumbered[id.value];
      std::sort(shown.begin(), shown.end());
    }
  }

  const Wardrobe& wardrobe_;
  const TemplateBody& body_;
  SubMeshLists lists_;
  std::vector<std::vector<std::uint32_t>> part_order_;  ///< per body part: FaceIds in draw order
  std::vector<VisibleFaces> visible_;                   ///< per combination
  std::vector<std::uint32_t> rank_;                     ///< per sub-mesh, before sorting
  std::map<std::string, MeshId> mesh_by_content_;
  std::map<std::string, IndexListId> list_by_content_;
  std::map<std::string, std::uint32_t> image_by_content_;
  std::map<std::array<std::uint32_t, 5>, SubMeshId> sub_mesh_by_content_;
};

constexpr const char* kTechniqueNames[] = {"naive", "prefitted", "tagged"};

}  // namespace

const char* toString(Technique technique) { return kTechniqueNames[static_cast<int>(technique)]; }

std::optional<Technique> parseTechnique(std::string_view name) {
  for (const Technique technique : kAllTechniques) {
    if (name == toString(technique)) return technique;
  }
  return std::nullopt;
}

std::uint64_t SubMeshLists::meshBytes() const {
  std::uint64_t bytes = 0;
  for (const Mesh& mesh : meshes) bytes += mesh.vertices.size() * sizeof(GpuVertex);
  for (const IndexList& list : index_lists) {
    bytes += list.indices.size() * (meshes[list.mesh].wide_indices ? 4u : 2u);
  }
  return bytes;
}

SubMeshLists buildSubMeshLists(const Wardrobe& wardrobe, std::span<const Combination> combinations,
                               Technique technique) {
  return ListsBuilder(wardrobe, combinations, technique).build();
}

std::uint64_t lowerBoundBytes(const Wardrobe& wardrobe, std::span<const Combination> combinations) {
  // Naive storage is exactly that: the template and the distinct garments, each once.
  return buildSubMeshLists(wardrobe, combinations, Technique::kNaive).meshBytes();
}

GpuVertex packVertex(const RawVertex& vertex) {
  GpuVertex packed{};
  for (int axis = 0; axis < 3; ++axis) packed.position[axis] = vertex.position[axis];
  const Vec2 octahedral = encodeOctahedral(vertex.normal);
  packed.normal_oct[0] = toSnorm16(octahedral.x);
  packed.normal_oct[1] = toSnorm16(octahedral.y);
  packed.uv[0] = vertex.uv.x;
  packed.uv[1] = vertex.uv.y;

  // Round the weights; what is missing to one goes to the largest, which is the first.
  int sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    packed.joints[i] = vertex.skin.joints[i];
    packed.weights[i] = toUnorm16(vertex.skin.weights[i]);
    sum += packed.weights[i];
  }
  if (sum > 0) packed.weights[0] = static_cast<std::uint16_t>(packed.weights[0] + 65535 - sum);
  return packed;
}

}  // namespace ensemble
