#include "assetpipe/combination_storage.h"

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "core/body_split.h"

namespace ensemble {
namespace {

/// Cells of the body that show, 64 a word.
using CellSet = std::vector<std::uint64_t>;

/// The body's faces by part and by the items that hide them. Whatever is worn, a cell shows whole or not at
/// all, so that a visible set is a set of cells.
class BodyCells {
 public:
  explicit BodyCells(const Wardrobe& wardrobe)
      : body_(wardrobe.body), cells_of_vertex_(body_.vertices.size()) {
    std::map<std::vector<bool>, std::uint32_t> number_of;
    for (std::size_t p = 0; p < body_.parts.size(); ++p) {
      const BodyPart& part = body_.parts[p];
      number_of.clear();
      for (std::uint32_t f = part.first_face; f < part.first_face + part.face_count; ++f) {
        std::vector<bool> visible_under;
        for (const Item& item : wardrobe.items) visible_under.push_back(item.visible[FaceId(f)] != 0);
        const auto next = static_cast<std::uint32_t>(faces_.size());
        const auto [entry, is_new] = number_of.try_emplace(visible_under, next);
        if (is_new) addCell(static_cast<std::uint32_t>(p), visible_under);
        ++faces_[entry->second];
        for (const std::uint32_t vertex : body_.faces[FaceId(f)]) addUse(vertex, entry->second);
      }
    }
    under_item_.assign(wardrobe.items.size(), CellSet((faces_.size() + 63) / 64));
    for (std::size_t c = 0; c < faces_.size(); ++c) {
      for (std::size_t i = 0; i < wardrobe.items.size(); ++i) {
        if (visible_under_[c][i]) under_item_[i][c / 64] |= std::uint64_t{1} << (c % 64);
      }
    }
  }

  CellSet all() const {
    CellSet cells((faces_.size() + 63) / 64);
    for (std::size_t c = 0; c < faces_.size(); ++c) cells[c / 64] |= std::uint64_t{1} << (c % 64);
    return cells;
  }
  CellSet under(CellSet cells, ItemId item) const {
    const CellSet& visible = under_item_[item.value];
    for (std::size_t i = 0; i < cells.size(); ++i) cells[i] &= visible[i];
    return cells;
  }

  /// Adds what some distinct visible bodies store. @param sets distinct
  void store(const std::set<CellSet>& sets, CombinationStorage& stored) const {
    std::vector<std::set<CellSet>> shown(body_.parts.size());  // per part: what shows of it
    for (const CellSet& set : sets) {
      std::vector<CellSet> of_part(body_.parts.size(), CellSet(set.size()));
      std::uint64_t faces = 0;
      for (std::size_t c = 0; c < faces_.size(); ++c) {
        if (!has(set, c)) continue;
        faces += faces_[c];
        of_part[part_of_[c]][c / 64] |= std::uint64_t{1} << (c % 64);
      }
      for (std::size_t p = 0; p < of_part.size(); ++p) {
        if (facesOf(of_part[p]) > 0) shown[p].insert(std::move(of_part[p]));
      }
      const std::uint64_t vertices = usedVertices(set);
      stored.prefitted_bytes += vertices * sizeof(GpuVertex) + faces * 3 * (vertices > 65536 ? 4u : 2u);
    }
    stored.visible_bodies += sets.size();
    for (std::size_t p = 0; p < shown.size(); ++p) storePart(body_.parts[p].face_count, shown[p], stored);
  }

  /// The dedicated lists of a part, without what is listed once for all (core/body_split.h).
  void storePart(std::uint64_t part_faces, const std::set<CellSet>& shown, CombinationStorage& stored) const {
    CellSet core = all();
    std::vector<std::uint64_t> partial;
    for (const CellSet& cells : shown) {
      for (std::size_t i = 0; i < core.size(); ++i) core[i] &= cells[i];
      if (facesOf(cells) < part_faces) partial.push_back(facesOf(cells));
    }
    const std::uint64_t core_faces = shown.empty() ? 0 : facesOf(core);
    const std::uint64_t once = isSplit(partial.size(), core_faces) ? core_faces : 0;
    for (const std::uint64_t faces : partial) {
      if (faces == once) continue;
      ++stored.dedicated_sub_meshes;
      stored.tagged_bytes += (faces - once) * 3 * (body_.vertices.size() > 65536 ? 4u : 2u);
    }
  }

  /// Bytes of the whole template, which pre-fitted storage has none of.
  std::uint64_t templateBytes() const {
    const std::uint64_t vertices = usedVertices(all());
    return vertices * sizeof(GpuVertex) + body_.faces.size() * 3 * (vertices > 65536 ? 4u : 2u);
  }

 private:
  static bool has(const CellSet& set, std::size_t cell) { return (set[cell / 64] >> (cell % 64) & 1u) != 0; }

  std::uint64_t facesOf(const CellSet& cells) const {
    std::uint64_t faces = 0;
    for (std::size_t c = 0; c < faces_.size(); ++c) faces += has(cells, c) ? faces_[c] : 0;
    return faces;
  }

  void addCell(std::uint32_t part, std::vector<bool> visible_under) {
    faces_.push_back(0);
    part_of_.push_back(part);
    visible_under_.push_back(std::move(visible_under));
  }

  void addUse(std::uint32_t vertex, std::uint32_t cell) {
    std::vector<std::uint32_t>& cells = cells_of_vertex_[vertex];
    if (std::find(cells.begin(), cells.end(), cell) == cells.end()) cells.push_back(cell);
  }

  std::uint64_t usedVertices(const CellSet& set) const {
    return static_cast<std::uint64_t>(
        std::count_if(cells_of_vertex_.begin(), cells_of_vertex_.end(), [&](const auto& cells) {
          return std::any_of(cells.begin(), cells.end(), [&](std::uint32_t c) { return has(set, c); });
        }));
  }

  const TemplateBody& body_;
  std::vector<std::uint32_t> faces_, part_of_;    ///< per cell
  std::vector<std::vector<bool>> visible_under_;  ///< per cell, per item
  std::vector<CellSet> under_item_;               ///< per item: cells that show
  std::vector<std::vector<std::uint32_t>> cells_of_vertex_;
};

/// What stays the same whatever is combined: the template and the items.
CombinationStorage storeItems(const Wardrobe& wardrobe, std::span<const Combination> combinations,
                              const BodyCells& cells) {
  CombinationStorage stored;
  stored.lower_bound_bytes = lowerBoundBytes(wardrobe, combinations);
  stored.tagged_bytes = stored.lower_bound_bytes;
  stored.prefitted_bytes = stored.lower_bound_bytes - cells.templateBytes();
  return stored;
}

std::vector<Combination> eachItem(const Wardrobe& wardrobe) {
  std::vector<Combination> items;
  for (std::size_t i = 0; i < wardrobe.items.size(); ++i) items.push_back({ItemId(i)});
  return items;
}

/// Every set under one of the items; and each as it is, where nothing need be worn of them.
std::set<CellSet> underEach(const std::set<CellSet>& sets, const std::vector<ItemId>& items, bool or_none,
                            const BodyCells& cells, std::size_t most) {
  std::set<CellSet> result;
  if (or_none) result = sets;
  for (const CellSet& set : sets) {
    for (const ItemId item : items) {
      result.insert(cells.under(set, item));
      if (result.size() > most) return result;
    }
  }
  return result;
}

}  // namespace

CombinationStorage& CombinationStorage::operator+=(const CombinationStorage& other) {
  visible_bodies += other.visible_bodies;
  dedicated_sub_meshes += other.dedicated_sub_meshes;
  lower_bound_bytes += other.lower_bound_bytes;
  tagged_bytes += other.tagged_bytes;
  prefitted_bytes += other.prefitted_bytes;
  return *this;
}

CombinationStorage storeCombinations(const Wardrobe& wardrobe, std::span<const Combination> combinations) {
  const BodyCells cells(wardrobe);
  std::set<CellSet> sets;
  std::set<ItemId> worn;
  for (const Combination& combination : combinations) {
    CellSet set = cells.all();
    for (const ItemId item : combination) set = cells.under(std::move(set), item);
    sets.insert(std::move(set));
    worn.insert(combination.begin(), combination.end());
  }
  std::vector<Combination> items;
  for (const ItemId item : worn) items.push_back({item});
  CombinationStorage stored = storeItems(wardrobe, items, cells);
  cells.store(sets, stored);
  return stored;
}

WardrobeCombinations countWardrobe(const Wardrobe& wardrobe, std::size_t most_bodies) {
  PerSlot<std::vector<ItemId>> items;
  for (std::size_t i = 0; i < wardrobe.items.size(); ++i) {
    items[wardrobe.items[ItemId(i)].slot].push_back(ItemId(i));
  }
  WardrobeCombinations all;
  for (const Slot slot : kAllSlots) all.items[slot] = items[slot].size();
  all.count = countCombinations(all.items);

  const BodyCells cells(wardrobe);
  const std::set<CellSet> bare{cells.all()};
  std::set<CellSet> sets = underEach(bare, items[Slot::kUpper], false, cells, most_bodies);
  sets = underEach(sets, items[Slot::kLower], false, cells, most_bodies);
  sets.merge(underEach(bare, items[Slot::kFull], false, cells, most_bodies));
  for (const Slot slot : kAllSlots) {
    if (isOptional(slot)) sets = underEach(sets, items[slot], true, cells, most_bodies);
    if (sets.size() > most_bodies) return all;
  }
  all.stored = storeItems(wardrobe, eachItem(wardrobe), cells);
  cells.store(sets, *all.stored);
  return all;
}

}  // namespace ensemble
