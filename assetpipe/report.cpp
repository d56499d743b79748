// Lister, Laycock and Day, section 5 (table 2) and section 6 (figure 6).
#include "assetpipe/report.h"

#include <algorithm>
#include <set>

namespace ensemble {
namespace {

/// The lists of naive storage, which tagged storage holds once for all outfits, too: by their faces.
std::set<std::vector<std::uint32_t>> genericLists(const SubMeshLists& naive) {
  std::set<std::vector<std::uint32_t>> generic;
  for (const IndexList& list : naive.index_lists) {
    if (list.is_template) generic.insert(list.source_faces);
  }
  return generic;
}

/// Sorts the lists of one technique by what they are for.
class ListCosts {
 public:
  ListCosts(const SubMeshLists& lists, const std::set<std::vector<std::uint32_t>>& generic) : lists_(lists) {
    part_of_list_.assign(lists.index_lists.size(), &StoredParts::body);
    part_of_mesh_.assign(lists.meshes.size(), &StoredParts::body);
    for (const SubMesh& sub_mesh : lists.sub_meshes) {
      const IndexList& list = lists.index_lists[sub_mesh.list];
      const bool is_garment = sub_mesh.kind == SubMeshKind::kGarment;
      const bool is_shared =
          lists.technique != Technique::kPrefitted && list.is_template && generic.contains(list.source_faces);
      part_of_list_[sub_mesh.list.value] = is_garment  ? &StoredParts::garments
                                           : is_shared ? &StoredParts::body
                                                       : &StoredParts::fitted;
      const bool owns_vertices = lists.technique == Technique::kPrefitted || !list.is_template;
      if (is_garment || owns_vertices) part_of_mesh_[list.mesh.value] = part_of_list_[sub_mesh.list.value];
    }
  }

  StoredParts total() const {
    StoredParts parts;
    for (std::size_t m = 0; m < part_of_mesh_.size(); ++m) addMesh(MeshId(m), parts);
    for (std::size_t l = 0; l < part_of_list_.size(); ++l) addList(IndexListId(l), parts);
    return parts;
  }

  /// What one combination uses, without the template.
  StoredParts of(std::size_t combination) const {
    std::set<std::uint32_t> meshes, index_lists;
    for (const SubMeshId id : lists_.shown[combination]) {
      const IndexListId list = lists_.sub_meshes[id].list;
      index_lists.insert(list.value);
      meshes.insert(lists_.index_lists[list].mesh.value);
    }
    StoredParts parts;
    for (const std::uint32_t mesh : meshes) addMesh(MeshId(mesh), parts);
    for (const std::uint32_t list : index_lists) addList(IndexListId(list), parts);
    parts.body = 0;
    return parts;
  }

 private:
  void addMesh(MeshId id, StoredParts& parts) const {
    parts.*part_of_mesh_[id.value] += lists_.meshes[id].vertices.size() * sizeof(GpuVertex);
  }
  void addList(IndexListId id, StoredParts& parts) const {
    const IndexList& list = lists_.index_lists[id];
    parts.*part_of_list_[id.value] += list.indices.size() * (lists_.meshes[list.mesh].wide_indices ? 4u : 2u);
  }

  const SubMeshLists& lists_;
  std::vector<std::uint64_t StoredParts::*> part_of_list_, part_of_mesh_;
};

/// The numbers of outfits that the curve shows.
std::set<std::uint64_t> curveCounts(std::uint64_t measured, std::uint64_t last) {
  constexpr std::uint64_t kPlaces = 100;
  std::set<std::uint64_t> counts;
  const std::uint64_t places = std::min(last, kPlaces);
  for (std::uint64_t i = 0; i < places; ++i) {
    counts.insert(places == 1 ? 1 : 1 + ((last - 1) * i + (places - 1) / 2) / (places - 1));
  }
  if (measured >= 1 && measured <= last) counts.insert(measured);
  return counts;
}

}  // namespace

StoredFaces countStoredFaces(std::uint64_t template_faces, std::span<const OutfitFaces> outfits) {
  StoredFaces faces{{template_faces, 0, template_faces}};
  for (const OutfitFaces& outfit : outfits) {
    faces.of[static_cast<std::size_t>(Technique::kNaive)] += outfit.garments;
    faces.of[static_cast<std::size_t>(Technique::kPrefitted)] += outfit.garments + outfit.visible_body;
    faces.of[static_cast<std::size_t>(Technique::kTagged)] += outfit.garments + outfit.dedicated;
  }
  return faces;
}

StoredFaces extrapolateStoredFaces(std::uint64_t template_faces, std::span<const OutfitFaces> outfits,
                                   std::uint64_t outfit_count) {
  StoredFaces result{{template_faces, 0, template_faces}};
  if (outfits.empty()) return result;
  const StoredFaces known = countStoredFaces(0, outfits);
  for (std::size_t t = 0; t < 3; ++t) {
    result.of[t] += (known.of[t] * outfit_count + outfits.size() / 2) / outfits.size();
  }
  return result;
}

TechniqueParts outfitFaceParts(const OutfitFaces& faces) {
  return {{{0, faces.garments, 0},
           {0, faces.garments, faces.visible_body},
           {0, faces.garments, faces.dedicated}}};
}

Extrapolation extrapolate(std::uint64_t template_faces, std::span<const OutfitFaces> outfits,
                          std::uint64_t outfit_count) {
  Extrapolation result;
  result.outfits = outfit_count;
  const auto share = [](const StoredFaces& faces) -> std::optional<double> {
    if (faces[Technique::kPrefitted] == 0) return std::nullopt;
    return static_cast<double>(faces[Technique::kTagged]) / static_cast<double>(faces[Technique::kPrefitted]);
  };
  for (const std::uint64_t count : curveCounts(outfits.size(), outfit_count)) {
    const StoredFaces faces = extrapolateStoredFaces(template_faces, outfits, count);
    result.curve.push_back({count, faces, share(faces)});
  }
  result.limit = share(countStoredFaces(0, outfits));
  return result;
}

Report makeReport(const Wardrobe& wardrobe, std::uint64_t extrapolate_to) {
  Report report;
  report.template_faces = wardrobe.body.faces.size();
  for (const Region& region : wardrobe.body.regions) {
    report.region_names.push_back(region.name);
    report.region_faces.push_back(region.face_count);
  }
  std::vector<Combination> combinations;
  for (std::size_t i = 0; i < wardrobe.items.size(); ++i) {
    const Item& item = wardrobe.items[ItemId(i)];
    report.outfit_names.push_back(item.name);
    report.outfits.push_back(
        {item.garmentFaceCount(), item.visibleBodyFaceCount(), item.dedicatedFaceCount()});
    report.tags.push_back(item.tags.raw());
    combinations.push_back({ItemId(i)});
  }
  report.faces = countStoredFaces(report.template_faces, report.outfits);
  report.outfit_bytes.resize(combinations.size());
  const auto generic = genericLists(buildSubMeshLists(wardrobe, combinations, Technique::kNaive));
  for (const Technique technique : kAllTechniques) {
    const auto t = static_cast<std::size_t>(technique);
    const SubMeshLists lists = buildSubMeshLists(wardrobe, combinations, technique);
    const ListCosts costs(lists, generic);
    report.bytes[t] = lists.meshBytes();
    report.byte_parts[t] = costs.total();
    for (std::size_t c = 0; c < combinations.size(); ++c) report.outfit_bytes[c][t] = costs.of(c);
  }
  report.lower_bound_bytes = lowerBoundBytes(wardrobe, combinations);
  if (extrapolate_to > 0) {
    report.extrapolation = extrapolate(report.template_faces, report.outfits, extrapolate_to);
  }
  report.combinations = countWardrobe(wardrobe);
  return report;
}

}  // namespace ensemble
