// Sub-mesh lists of the three techniques compared by Lister, Laycock and Day, "Geometric Diversity
// for Crowds on the GPU", section 3.1: naive (3.1.1), pre-fitted (3.1.2) and tagged (3.1.3).
#include "core/sub_mesh_lists.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <numeric>

#include "core/body_split.h"
#include "core/check.h"
#include "core/garment_split.h"
#include "core/hash.h"

namespace ensemble {
namespace {

constexpr std::size_t kMaxNarrowVertices = 65536;

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
    for (const Combination& combination : lists_.combinations) addVisibleFaces(combination);
    orderTemplateFaces();
    const std::size_t count = lists_.combinations.size();
    hidden_in_ = hiddenSets(wardrobe_, lists_.combinations, &hidden_set_);
    for (std::size_t c = 0; c < count; ++c) {
      for (const ItemId item : lists_.combinations[c]) showGarments(c, item);
    }
    for (std::size_t c = 0; c < count; ++c) {
      for (const ItemId item : lists_.combinations[c]) showAll(c, extraBodyOf(item));
    }
    body_sub_meshes_.resize(visible_.size());
    if (lists_.technique == Technique::kPrefitted) {
      addPrefittedBodies();
    } else {
      addTemplate();
    }
    for (std::size_t c = 0; c < count; ++c) showAll(c, body_sub_meshes_[lists_.hidden_set[c]]);
    sortSubMeshes();
    return std::move(lists_);
  }

 private:
  using VisibleFaces = std::vector<std::uint8_t>;  ///< per template face

  /// One order of the template's faces that every list is a subsequence of.
  void orderTemplateFaces() {
    std::vector<std::vector<std::uint32_t>> orders;
    for (const BodyPart& part : body_.parts) {
      const std::span faces(body_.faces.raw().data() + part.first_face, part.face_count);
      std::vector<std::uint32_t> order = vertexCacheOrder(faces, body_.vertices.size());
      for (std::uint32_t& face : order) face += part.first_face;
      orders.push_back(std::move(order));
    }
    parts_ = splitBody(body_, std::move(orders), visible_);
  }

  /// The visible faces of a combination, stored once by content.
  void addVisibleFaces(const Combination& combination) {
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
    const auto next = static_cast<std::uint32_t>(visible_.size());
    const auto [entry, is_new] = set_by_content_.try_emplace(hidden, next);
    if (is_new) {
      visible_.push_back(std::move(visible));
      lists_.hidden_sets.push_back(std::move(hidden));
    }
    lists_.hidden_set.push_back(entry->second);
  }

  /// tagged and pre-fitted: the pieces that show; naive: all, of which hidden ones cast no shadow.
  void showGarments(std::size_t combination, ItemId item) {
    ItemGarments& garments = garments_of_item_[item];
    if (garments.sub_meshes.empty()) addGarments(item, garments);
    const std::vector<std::uint8_t>& hidden = garments.split.hidden[hidden_set_[combination].at(item)];
    std::vector<SubMeshId> shown;
    for (std::size_t piece = 0; piece < garments.sub_meshes.size(); ++piece) {
      SubMeshId id = garments.sub_meshes[piece];
      if (!id.valid()) continue;
      if (hidden[piece] != 0) {
        if (lists_.technique != Technique::kNaive) continue;
        SubMesh covered = lists_.sub_meshes[id];
        covered.is_covered = true;
        id = addSubMesh(covered, 0);
      }
      shown.push_back(id);
    }
    showAll(combination, shown);
  }

  /// What is drawn of an item's garments.
  struct ItemGarments {
    GarmentSplit split;                 ///< by what all combinations hide of it
    std::vector<SubMeshId> sub_meshes;  ///< per piece
  };

  void addGarments(ItemId item_id, ItemGarments& garments) {
    const Item& item = wardrobe_.items[item_id];
    garments.split = splitGarments(item, hidden_in_.at(item_id).sets);
    garments.sub_meshes.resize(garments.split.piece_count);
    std::span<const std::uint32_t> piece_of_face = garments.split.piece_of_face;
    for (const Garment& garment : item.garments) {
      std::uint32_t face_offset = 0;
      for (const ItemPart& part : garment.parts) {
        if (part.faces.empty()) continue;
        const std::uint32_t material = addMaterial(item.materials[part.material], item.images, false);
        const std::span<const Garment> alike =
            item.slot == Slot::kFull ? std::span(&garment, 1) : std::span(item.garments);
        const SubMesh sub_mesh{SubMeshKind::kGarment,
                               {},
                               material,
                               addGarmentName(garment.name),
                               face_offset,
                               item.slot,
                               mainMaterial(item, alike),
                               garment.parts.size() > 1};
        addPieces(part, piece_of_face.first(part.faces.size()), sub_mesh, garments.sub_meshes);
        piece_of_face = piece_of_face.subspan(part.faces.size());
        face_offset += static_cast<std::uint32_t>(part.faces.size());
      }
    }
  }

  /// The pieces of a part, as lists into one mesh, each a subsequence of the part's order.
  void addPieces(const ItemPart& part, std::span<const std::uint32_t> piece_of_face, SubMesh sub_mesh,
                 std::vector<SubMeshId>& sub_meshes) {
    const IndexList whole = partList(part);
    std::map<std::uint32_t, IndexList> lists;
    for (std::size_t i = 0; i < whole.source_faces.size(); ++i) {
      IndexList& list = lists[piece_of_face[whole.source_faces[i]]];
      list.mesh = whole.mesh;
      const auto corners = whole.indices.begin() + static_cast<std::ptrdiff_t>(3 * i);
      list.indices.insert(list.indices.end(), corners, corners + 3);
      list.source_faces.push_back(whole.source_faces[i]);
    }
    for (auto& [piece, list] : lists) {
      sub_mesh.list = addList(std::move(list));
      sub_meshes[piece] = addSubMesh(sub_mesh, 0);
    }
  }

  /// The material of most faces of some of an item's garments.
  std::uint32_t mainMaterial(const Item& item, std::span<const Garment> garments) {
    std::map<std::uint32_t, std::size_t> faces;
    for (const Garment& garment : garments) {
      for (const ItemPart& part : garment.parts) faces[part.material] += part.faces.size();
    }
    const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
    const auto most = std::max_element(faces.begin(), faces.end(), fewer);
    return addMaterial(item.materials[most->first], item.images, false);
  }

  /// Body faces that only an item has: its geometry in every technique. Numbers follow the template's.
  const std::vector<SubMeshId>& extraBodyOf(ItemId item_id) {
    const auto [entry, is_new] = extra_of_item_.try_emplace(item_id);
    if (!is_new) return entry->second;
    const Item& item = wardrobe_.items[item_id];
    auto face_offset = static_cast<std::uint32_t>(body_.faces.size());
    for (const ExtraBodyPart& extra : item.extra_body) {
      if (extra.part.faces.empty()) continue;
      const SubMesh sub_mesh{SubMeshKind::kBody, addList(partList(extra.part)),
                             addMaterial(item.materials[extra.part.material], item.images, true),
                             extra.region.value, face_offset};
      entry->second.push_back(addSubMesh(sub_mesh, 1));
      face_offset += static_cast<std::uint32_t>(extra.part.faces.size());
    }
    return entry->second;
  }

  /// A part of an item becomes a mesh of its own, in vertex-cache order, renumbered by first use.
  IndexList partList(const ItemPart& part) {
    IndexList list;
    list.source_faces = vertexCacheOrder(part.faces, part.vertices.size());
    Mesh mesh = takeVertices(part.vertices, part.faces, list.source_faces, list.indices);
    list.mesh = addMesh(std::move(mesh), list.indices);
    return list;
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

  /// naive and tagged: the template once, a generic list per part; tagged: dedicated lists of parts of one.
  void addTemplate() {
    std::vector<std::uint32_t> all_indices, all_faces;
    for (const DrawPart& part : parts_)
      all_faces.insert(all_faces.end(), part.faces.begin(), part.faces.end());
    Mesh mesh = takeVertices(body_.vertices.raw(), body_.faces.raw(), all_faces, all_indices);
    std::vector<Triangle> corners(body_.faces.size());  // by FaceId, in the mesh's numbers
    for (std::size_t i = 0; i < all_faces.size(); ++i) {
      corners[all_faces[i]] = {all_indices[3 * i], all_indices[3 * i + 1], all_indices[3 * i + 2]};
    }
    const MeshId mesh_id = addMesh(std::move(mesh), all_indices);

    const VisibleFaces everything(body_.faces.size(), 1);
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      const IndexListId generic = addTemplateList(mesh_id, p, everything, corners);
      std::map<std::string, IndexListId> lists_of_part;  // by visible faces: sets differ in few parts each
      for (std::size_t set = 0; set < visible_.size(); ++set) {
        IndexListId list = generic;
        if (lists_.technique == Technique::kTagged) {
          std::string shown;
          for (const std::uint32_t face : parts_[p].faces) shown += visible_[set][face] != 0 ? '1' : '0';
          const auto [entry, is_new] = lists_of_part.try_emplace(std::move(shown));
          if (is_new) entry->second = addTemplateList(mesh_id, p, visible_[set], corners);
          list = entry->second;
        }
        addBodyPart(set, p, list);
      }
    }
  }

  /// pre-fitted: every distinct visible body owns its vertices, compacted.
  void addPrefittedBodies() {
    for (std::size_t set = 0; set < visible_.size(); ++set) {
      std::vector<std::uint32_t> faces, indices;
      for (const DrawPart& part : parts_) {
        std::copy_if(part.faces.begin(), part.faces.end(), std::back_inserter(faces),
                     [&](std::uint32_t face) { return visible_[set][face] != 0; });
      }
      if (faces.empty()) continue;
      Mesh mesh = takeVertices(body_.vertices.raw(), body_.faces.raw(), faces, indices);
      std::vector<Triangle> corners(body_.faces.size());
      for (std::size_t i = 0; i < faces.size(); ++i) {
        corners[faces[i]] = {indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]};
      }
      const MeshId mesh_id = addMesh(std::move(mesh), indices);
      for (std::size_t p = 0; p < parts_.size(); ++p) {
        addBodyPart(set, p, addTemplateList(mesh_id, p, visible_[set], corners));
      }
    }
  }

  /// The visible faces of a part as a list into a mesh; none() where there are none.
  IndexListId addTemplateList(MeshId mesh, std::size_t part, const VisibleFaces& visible,
                              std::span<const Triangle> corners) {
    IndexList list;
    list.mesh = mesh;
    list.is_template = true;
    for (const std::uint32_t face : parts_[part].faces) {
      if (visible[face] == 0) continue;
      list.source_faces.push_back(face);
      list.indices.insert(list.indices.end(), corners[face].begin(), corners[face].end());
    }
    return list.indices.empty() ? IndexListId::none() : addList(std::move(list));
  }

  void addBodyPart(std::size_t set, std::size_t part, IndexListId list) {
    if (!list.valid()) return;
    const BodyPart& of = body_.parts[parts_[part].part];
    const std::uint32_t material = addMaterial(body_.materials[of.material], body_.images, true);
    const SubMesh sub_mesh{SubMeshKind::kBody, list, material, of.region.value, 0};
    body_sub_meshes_[set].push_back(addSubMesh(sub_mesh, static_cast<std::uint32_t>(2 + part)));
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

  /// `rank` is its place in the order of drawing, the same in all techniques.
  SubMeshId addSubMesh(const SubMesh& sub_mesh, std::uint32_t rank) {
    const std::array<std::uint32_t, 9> key{sub_mesh.list.value,
                                           sub_mesh.material,
                                           sub_mesh.region,
                                           sub_mesh.source_face_offset,
                                           static_cast<std::uint32_t>(sub_mesh.kind),
                                           static_cast<std::uint32_t>(sub_mesh.slot),
                                           sub_mesh.main_material,
                                           sub_mesh.has_trimmings ? 1u : 0u,
                                           sub_mesh.is_covered ? 1u : 0u};
    const auto [entry, is_new] = sub_mesh_by_content_.try_emplace(key, SubMeshId(lists_.sub_meshes.size()));
    if (is_new) {
      lists_.sub_meshes.push(sub_mesh);
      rank_.push_back(rank);
    }
    return entry->second;
  }

  /// Lets a combination show sub-meshes, each once.
  void showAll(std::size_t combination, std::span<const SubMeshId> sub_meshes) {
    std::vector<SubMeshId>& shown = lists_.shown[combination];
    for (const SubMeshId id : sub_meshes) {
      if (std::find(shown.begin(), shown.end(), id) == shown.end()) shown.push_back(id);
    }
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
  std::vector<DrawPart> parts_;
  std::vector<VisibleFaces> visible_;  ///< distinct, as lists_.hidden_sets
  std::map<std::vector<std::uint32_t>, std::uint32_t> set_by_content_;
  std::vector<std::vector<SubMeshId>> body_sub_meshes_;  ///< per set of visible_
  std::map<ItemId, ItemGarments> garments_of_item_;
  std::map<ItemId, ItemSets> hidden_in_;
  std::vector<std::map<ItemId, std::size_t>> hidden_set_;  ///< per combination: index into an item's sets
  std::map<ItemId, std::vector<SubMeshId>> extra_of_item_;
  std::vector<std::uint32_t> rank_;  ///< per sub-mesh, before sorting
  std::map<std::string, MeshId> mesh_by_content_;
  std::map<std::string, IndexListId> list_by_content_;
  std::map<std::string, std::uint32_t> image_by_content_;
  std::map<std::array<std::uint32_t, 9>, SubMeshId> sub_mesh_by_content_;
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

}  // namespace ensemble
