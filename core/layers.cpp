#include "core/layers.h"

#include <set>

#include "core/box.h"
#include "core/check.h"

namespace ensemble {
namespace {

constexpr float kHandsWidth = 0.1f;  // metres

WearPlace placeOf(const Item& item) { return {item.slot, item.layer}; }

PerItem<Box> boxesOf(const Wardrobe& wardrobe) {
  PerItem<Box> boxes(wardrobe.items.size());
  for (std::size_t i = 0; i < wardrobe.items.size(); ++i) {
    for (const Garment& garment : wardrobe.items[ItemId(i)].garments) {
      for (const ItemPart& part : garment.parts) {
        for (const RawVertex& vertex : part.vertices) boxes[ItemId(i)].add(vertex.position);
      }
    }
  }
  return boxes;
}

bool areNear(const Box& a, const Box& b) {
  if (a.empty() || b.empty()) return false;
  const Vec3 gap = glm::max(glm::max(a.low - b.high, b.low - a.high), Vec3(0.0f));
  return glm::length(gap) <= kHandsWidth;
}

}  // namespace

std::vector<ItemPair> allLayerPairs(const Wardrobe& wardrobe) {
  const PerItem<Box> boxes = boxesOf(wardrobe);
  std::vector<ItemPair> pairs;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t o = 0; o < boxes.size(); ++o) {
      const ItemPair pair{ItemId(i), ItemId(o)};
      const bool is_over =
          isWornOver(placeOf(wardrobe.items[pair.outer]), placeOf(wardrobe.items[pair.inner]));
      if (is_over && areNear(boxes[pair.inner], boxes[pair.outer])) pairs.push_back(pair);
    }
  }
  return pairs;
}

std::vector<ItemPair> layerPairs(const Wardrobe& wardrobe, std::span<const Combination> combinations) {
  std::set<ItemPair> worn;
  for (const Combination& combination : combinations) {
    for (const ItemId inner : combination) {
      for (const ItemId outer : combination) worn.insert({inner, outer});
    }
  }
  std::vector<ItemPair> pairs;
  for (const ItemPair& pair : allLayerPairs(wardrobe)) {
    if (worn.contains(pair)) pairs.push_back(pair);
  }
  return pairs;
}

HiddenGarmentFaces hiddenInCombination(const Wardrobe& wardrobe, const Combination& combination,
                                       ItemId item) {
  HiddenGarmentFaces hidden;
  for (const ItemId outer : combination) {
    const auto found = wardrobe.hidden_under.find({item, outer});
    if (found == wardrobe.hidden_under.end()) continue;
    const HiddenGarmentFaces& under = found->second;
    ENSEMBLE_CHECK(under.size() == wardrobe.items[item].garmentFaceCount());
    hidden.resize(under.size(), 0);
    for (std::size_t face = 0; face < under.size(); ++face) hidden[face] |= under[face];
  }
  return hidden;
}

}  // namespace ensemble
