// An item's garments cut into pieces that combinations show whole or not at all (design 4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "core/sub_mesh_lists.h"
#include "core/wardrobe.h"

namespace ensemble {

/// More pieces of a part of a garment would cost more draws than they save faces.
inline constexpr std::size_t kMostPieces = 8;

struct GarmentSplit {
  /// Per face, numbered through all parts of all garments: its piece. A piece is of one part; pieces count up
  /// from part to part.
  std::vector<std::uint32_t> piece_of_face;
  std::uint32_t piece_count = 0;
  /// Per set of hidden faces and per piece: 1 where all of the piece is hidden, so that it isn't drawn.
  std::vector<std::vector<std::uint8_t>> hidden;
};

/// Cuts by what distinct sets of hidden faces hide. Where that gives more than `most` pieces of a part, the
/// smallest go with those with which the fewest faces are drawn needlessly.
/// @param sets of the item's garment faces; an empty one hides nothing
GarmentSplit splitGarments(const Item& item, std::span<const HiddenGarmentFaces> sets,
                           std::size_t most = kMostPieces);

/// What combinations hide of the items of a wardrobe.
struct ItemSets {
  std::vector<HiddenGarmentFaces> sets;  ///< distinct
  std::vector<std::size_t> times;        ///< per set: in how many combinations
};
/// Per item that is worn. @param set_of per combination and item: index into the item's sets; may be null
std::map<ItemId, ItemSets> hiddenSets(const Wardrobe& wardrobe, std::span<const Combination> combinations,
                                      std::vector<std::map<ItemId, std::size_t>>* set_of = nullptr);

/// Sums over distinct combinations.
struct LayerFigures {
  std::uint64_t pairs = 0;          ///< that are worn, one over the other, and of which something is hidden
  std::uint64_t garment_faces = 0;  ///< of all garments of all combinations
  std::uint64_t hidden_faces = 0;   ///< of these
  std::uint64_t drawn_faces = 0;    ///< of the same; pieces show whole or not at all
  std::uint64_t lists = 0;  ///< into which the garments are cut; a garment of one material is one if uncut

  LayerFigures& operator+=(const LayerFigures& other);
};
LayerFigures countLayers(const Wardrobe& wardrobe, std::span<const Combination> combinations);

}  // namespace ensemble
