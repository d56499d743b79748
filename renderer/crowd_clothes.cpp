#include "renderer/crowd_clothes.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/nearest_name.h"
#include "core/random.h"
#include "renderer/crowd_streams.h"

namespace ensemble {
namespace {

/// In a slot that the scene does not weigh: wearing nothing there, for each item's 1. A hat is worn by one
/// in four, a jacket by two in five; hair and shoes by everybody whose wardrobe has some.
constexpr float noneWeight(Slot slot) {
  return slot == Slot::kHead ? 3.0f : slot == Slot::kOver ? 1.5f : 0.0f;
}

constexpr const char* kNone = "none";

}  // namespace

CrowdClothes::CrowdClothes(const Scene& scene, std::span<const Wardrobe> wardrobes, const SceneNames& names)
    : scene_(scene), wardrobes_(wardrobes), names_(names), clothes_(wardrobes.size()) {}

void CrowdClothes::SlotChoice::add(ItemId item, float item_weight) {
  items.push_back(item);
  weight.add(item_weight);
  if (item.valid()) item_total += static_cast<double>(item_weight);
}

void CrowdClothes::weigh(const std::vector<bool>& is_used) {
  if (!scene_.crowd.outfits.empty()) {
    weighOutfits(is_used);
    return;
  }
  for (const SceneWear& wear : scene_.crowd.wear) weighListed(wear);
  for (std::uint32_t w = 0; w < clothes_.size(); ++w) {
    weighLeftOut(w);
    if (is_used[w]) checkDressed(w);
  }
}

void CrowdClothes::weighOutfits(const std::vector<bool>& is_used) {
  for (const WeightedName& named : scene_.crowd.outfits) {
    const FoundOutfit found = names_.outfit(named.name, named.mark);
    WardrobeClothes& clothes = clothes_[found.wardrobe];
    if (std::find(clothes.outfits.begin(), clothes.outfits.end(), found.items) != clothes.outfits.end()) {
      names_.fail(named.mark, fmt::format("the outfit {} is here a second time", quotedName(named.name)),
                  "remove one of them");
    }
    clothes.outfits.push_back(found.items);
    clothes.outfit.add(named.weight);
  }
  for (std::uint32_t w = 0; w < clothes_.size(); ++w) {
    if (!is_used[w] || clothes_[w].outfit.total() > 0.0) continue;
    names_.fail(scene_.crowd.outfits.front().mark,
                fmt::format("crowd.outfits has nothing to wear for {}", names_.describe(w)),
                "list an outfit of it with a weight above 0, or give the wardrobe the weight 0 in "
                "crowd.wardrobes");
  }
}

void CrowdClothes::weighListed(const SceneWear& wear) {
  for (const WeightedName& named : wear.items) {
    if (named.name != kNone) {
      weighListedItem(wear, named);
      continue;
    }
    for (WardrobeClothes& clothes : clothes_) clothes.slots[wear.slot].add(ItemId::none(), named.weight);
  }
}

/// A bare name is the item of every wardrobe that has it, since recipes make the same for all.
void CrowdClothes::weighListedItem(const SceneWear& wear, const WeightedName& named) {
  bool is_found = false;
  for (std::uint32_t w = 0; w < clothes_.size(); ++w) {
    const ItemId item = names_.findItemOf(w, named.name);
    if (!item.valid()) continue;
    is_found = true;
    addListed(w, wear.slot, item, named);
  }
  if (!is_found) names_.failNoItem(wear.slot, named.name, named.mark);
}

void CrowdClothes::addListed(std::uint32_t wardrobe, Slot slot, ItemId item, const WeightedName& named) {
  const Slot own = wardrobes_[wardrobe].items[item].slot;
  if (own != slot) {
    names_.fail(named.mark, fmt::format("{} is of the slot '{}'", quotedName(named.name), toString(own)),
                fmt::format("move it to crowd.wear.{}", toString(own)));
  }
  SlotChoice& choice = clothes_[wardrobe].slots[slot];
  if (std::find(choice.items.begin(), choice.items.end(), item) != choice.items.end()) {
    names_.fail(named.mark, fmt::format("the item {} is here a second time", quotedName(named.name)),
                "remove one of them");
  }
  choice.add(item, named.weight);
}

/// Slots that the scene does not list: every item alike. A full one is then worn as often as an upper one.
void CrowdClothes::weighLeftOut(std::uint32_t wardrobe) {
  const PerItem<Item>& items = wardrobes_[wardrobe].items;
  PerSlot<SlotChoice>& slots = clothes_[wardrobe].slots;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Slot slot = items[ItemId(i)].slot;
    if (listed(slot) == nullptr) slots[slot].add(ItemId(i), 1.0f);
  }
  for (const Slot slot : kAllSlots) {
    if (listed(slot) != nullptr || !isOptional(slot)) continue;
    slots[slot].add(ItemId::none(), noneWeight(slot) * static_cast<float>(slots[slot].items.size()));
  }
  if (listed(Slot::kFull) != nullptr) return;
  const std::vector<ItemId>& uppers = slots[Slot::kUpper].items;
  const bool has_halves = slots[Slot::kUpper].item_total > 0.0 && slots[Slot::kLower].item_total > 0.0;
  slots[Slot::kFull].add(ItemId::none(), has_halves ? static_cast<float>(uppers.size()) : 0.0f);
}

const SceneWear* CrowdClothes::listed(Slot slot) const {
  for (const SceneWear& wear : scene_.crowd.wear) {
    if (wear.slot == slot) return &wear;
  }
  return nullptr;
}

/// People wear a full item, or an upper and a lower one. Only a wardrobe without any item leaves them bare.
void CrowdClothes::checkDressed(std::uint32_t wardrobe) const {
  if (wardrobes_[wardrobe].items.empty()) return;
  const PerSlot<SlotChoice>& slots = clothes_[wardrobe].slots;
  const SlotChoice& full = slots[Slot::kFull];
  const bool wears_halves = full.weight.total() > full.item_total;
  if (!wears_halves && full.item_total > 0.0) return;
  for (const Slot slot : {Slot::kUpper, Slot::kLower}) {
    if (slots[slot].item_total > 0.0) continue;
    if (const SceneWear* wear = listed(slot)) {
      names_.fail(wear->mark,
                  fmt::format("crowd.wear.{} has nothing for {}", toString(slot), names_.describe(wardrobe)),
                  "list an item of it with a weight above 0, or give the wardrobe the weight 0 in "
                  "crowd.wardrobes");
    }
    const SceneWear* wear = listed(Slot::kFull);
    names_.fail(wear != nullptr ? wear->mark : SourceMark{0, 0, "crowd"},
                fmt::format("{} has no item of the slot '{}'{}", names_.describe(wardrobe), toString(slot),
                            full.item_total > 0.0 ? "" : " and none of 'full'"),
                "add one, or name what people wear in crowd.outfits");
  }
}

Combination CrowdClothes::of(std::uint32_t wardrobe, std::uint32_t person) const {
  const std::uint64_t seed = scene_.crowd.seed;
  const WardrobeClothes& clothes = clothes_[wardrobe];
  const double u = RandomStream(seed, crowd_stream::kOutfit).uniform(person);
  if (!clothes.outfits.empty()) return clothes.outfits[clothes.outfit.choose(u)];
  Combination items;
  const auto wear = [&](Slot slot, double chance) {
    const SlotChoice& choice = clothes.slots[slot];
    if (!(choice.weight.total() > 0.0)) return;
    const ItemId item = choice.items[choice.weight.choose(chance)];
    if (item.valid()) items.push_back(item);
  };
  wear(Slot::kFull, u);
  const bool is_full = !items.empty();
  for (const Slot slot : kAllSlots) {
    if (slot == Slot::kFull || (is_full && exclude(slot, Slot::kFull))) continue;
    wear(slot, RandomStream(seed, crowd_stream::kWear + static_cast<std::uint64_t>(slot)).uniform(person));
  }
  std::sort(items.begin(), items.end());
  return items;
}

}  // namespace ensemble
