#include "core/garment_split.h"

#include <gtest/gtest.h>

#include <set>

#include "core/layers.h"

namespace ensemble {
namespace {

/// An item of two garments: one part of 4 faces; two parts of 3 and 2.
Item item() {
  Item item;
  item.garments = {{"shirt", {ItemPart()}}, {"tie", {ItemPart(), ItemPart()}}};
  item.garments[0].parts[0].faces.resize(4);
  item.garments[1].parts[0].faces.resize(3);
  item.garments[1].parts[1].faces.resize(2);
  return item;
}

/// Per set the faces that its hidden pieces hold.
std::vector<std::set<std::size_t>> hiddenFaces(const GarmentSplit& split) {
  std::vector<std::set<std::size_t>> faces(split.hidden.size());
  for (std::size_t s = 0; s < split.hidden.size(); ++s) {
    EXPECT_EQ(split.hidden[s].size(), split.piece_count);
    for (std::size_t f = 0; f < split.piece_of_face.size(); ++f) {
      if (split.hidden[s][split.piece_of_face[f]] != 0) faces[s].insert(f);
    }
  }
  return faces;
}

TEST(GarmentSplit, WhatIsNeverHiddenIsOnePieceAPart) {
  const GarmentSplit split = splitGarments(item(), std::vector<HiddenGarmentFaces>{{}});
  EXPECT_EQ(split.piece_count, 3u);
  EXPECT_EQ(split.piece_of_face, (std::vector<std::uint32_t>{0, 0, 0, 0, 1, 1, 1, 2, 2}));
  EXPECT_TRUE(hiddenFaces(split)[0].empty());
}

TEST(GarmentSplit, PiecesAreWhatSetsTellApart) {
  const std::vector<HiddenGarmentFaces> sets = {{}, {1, 1, 0, 0, 0, 0, 0, 1, 1}, {0, 1, 1, 0, 0, 0, 0, 0, 0}};
  const GarmentSplit split = splitGarments(item(), sets);
  EXPECT_EQ(split.piece_count, 6u) << "face by face of the first part, and the two others whole";
  const auto hidden = hiddenFaces(split);
  EXPECT_TRUE(hidden[0].empty());
  EXPECT_EQ(hidden[1], (std::set<std::size_t>{0, 1, 7, 8}));
  EXPECT_EQ(hidden[2], (std::set<std::size_t>{1, 2}));
}

// Of pieces of 2, 1 and 1 faces the last two cost the least together: one face, in each of two sets.
TEST(GarmentSplit, FewerPiecesNeverHideMore) {
  Item one = item();
  one.garments.resize(1);
  const std::vector<HiddenGarmentFaces> sets = {{1, 1, 0, 0}, {1, 1, 1, 0}, {1, 1, 0, 1}};
  const GarmentSplit all = splitGarments(one, sets), two = splitGarments(one, sets, 2),
                     single = splitGarments(one, sets, 1);
  EXPECT_EQ(all.piece_count, 3u);
  EXPECT_EQ(two.piece_count, 2u);
  EXPECT_EQ(single.piece_count, 1u);
  for (std::size_t s = 0; s < sets.size(); ++s) {
    EXPECT_EQ(hiddenFaces(two)[s], (std::set<std::size_t>{0, 1}));
    EXPECT_TRUE(hiddenFaces(single)[s].empty());
    const std::set<std::size_t> hidden = hiddenFaces(all)[s];
    for (std::size_t face = 0; face < 4; ++face) EXPECT_EQ(hidden.contains(face), sets[s][face] == 1);
  }
}

TEST(GarmentSplit, FiguresCountWhatIsHiddenAndWhatIsDrawn) {
  Wardrobe wardrobe;
  for (const Slot slot : {Slot::kUpper, Slot::kOver}) {
    wardrobe.items.push(item());
    wardrobe.items[ItemId(wardrobe.items.size() - 1)].slot = slot;
    for (Garment& garment : wardrobe.items[ItemId(wardrobe.items.size() - 1)].garments) {
      for (ItemPart& part : garment.parts) part.vertices.resize(1);
    }
  }
  wardrobe.hidden_under[{ItemId(0), ItemId(1)}] = {1, 1, 0, 0, 0, 0, 0, 1, 1};
  const std::vector<Combination> worn = {{ItemId(0)}, {ItemId(0), ItemId(1)}};
  const LayerFigures figures = countLayers(wardrobe, worn);
  EXPECT_EQ(figures.pairs, 1u);
  EXPECT_EQ(figures.garment_faces, 27u);
  EXPECT_EQ(figures.hidden_faces, 4u);
  EXPECT_EQ(figures.drawn_faces, 23u);
  EXPECT_EQ(figures.lists, 4u + 3u);
}

}  // namespace
}  // namespace ensemble
