// What is worn over what in combinations of items (design 4): pairs, and what is left of an inner item.
#pragma once

#include <span>
#include <vector>

#include "core/sub_mesh_lists.h"
#include "core/wardrobe.h"

namespace ensemble {

/// The pairs of which the outer item may hide some of the inner one: worn together in one of the
/// combinations, one over the other, and no further apart in the bind pose than a hand's width. Ascending,
/// each once.
std::vector<ItemPair> layerPairs(const Wardrobe& wardrobe, std::span<const Combination> combinations);

/// Every such pair of a wardrobe's items, whoever wears them.
std::vector<ItemPair> allLayerPairs(const Wardrobe& wardrobe);

/// What the others of a combination hide of an item of it. Empty: nothing.
HiddenGarmentFaces hiddenInCombination(const Wardrobe& wardrobe, const Combination& combination, ItemId item);

}  // namespace ensemble
