// What the crowd wears: fixed outfits, or items combined person by person (core/slots.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene.h"
#include "core/slots.h"
#include "core/wardrobe.h"
#include "renderer/scene_names.h"
#include "renderer/weighted_choice.h"

namespace ensemble {

class CrowdClothes {
 public:
  /// Scene, wardrobes and names must outlive this.
  CrowdClothes(const Scene& scene, std::span<const Wardrobe> wardrobes, const SceneNames& names);

  /// Reads crowd.outfits, or crowd.wear, for the wardrobes that somebody is dressed from.
  /// @param is_used one for each wardrobe
  /// @throws InputError for unknown names, naming the nearest; for an item under another slot than its own;
  /// for a wardrobe that can't dress a person
  void weigh(const std::vector<bool>& is_used);

  /// What somebody of the crowd wears, a function of the scene's seed and the person's number alone.
  /// @pre the wardrobe was used in weigh()
  Combination of(std::uint32_t wardrobe, std::uint32_t person) const;

 private:
  /// Items of a slot; none() for wearing nothing there.
  struct SlotChoice {
    std::vector<ItemId> items;
    WeightedChoice weight;
    double item_total = 0.0;  ///< weight.total() without that of none()
    void add(ItemId item, float item_weight);
  };
  struct WardrobeClothes {
    std::vector<Combination> outfits;  ///< of crowd.outfits; empty: `slots`
    WeightedChoice outfit;
    PerSlot<SlotChoice> slots;
  };

  void weighOutfits(const std::vector<bool>& is_used);
  void weighListed(const SceneWear& wear);
  void weighListedItem(const SceneWear& wear, const WeightedName& named);
  void addListed(std::uint32_t wardrobe, Slot slot, ItemId item, const WeightedName& named);
  void weighLeftOut(std::uint32_t wardrobe);
  void checkDressed(std::uint32_t wardrobe) const;
  const SceneWear* listed(Slot slot) const;

  const Scene& scene_;
  std::span<const Wardrobe> wardrobes_;
  const SceneNames& names_;
  std::vector<WardrobeClothes> clothes_;
};

}  // namespace ensemble
