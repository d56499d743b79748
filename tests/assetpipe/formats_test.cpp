// A file of every format version: an old one loads, or is refused by name (tests/formats).
#include <gtest/gtest.h>

#include "core/wardrobe.h"

namespace ensemble {
namespace {

TEST(Formats, Wardrobe1Loads) {
  const Wardrobe wardrobe = loadWardrobe("tests/formats/wardrobe-1");
  ASSERT_EQ(wardrobe.items.size(), 1u);
  EXPECT_EQ(wardrobe.body.faces.size(), 192u);
  EXPECT_EQ(wardrobe.body.clips.at(0).name, "sway");
  const Item& tunic = wardrobe.items[ItemId(0)];
  EXPECT_EQ(tunic.name, "tunic");
  EXPECT_EQ(tunic.tags[RegionId(0)].visibility, Visibility::kFull);
  EXPECT_EQ(tunic.tags[RegionId(1)].visible_faces, 32u);
  EXPECT_EQ(tunic.tags[RegionId(2)].visibility, Visibility::kHidden);
}

}  // namespace
}  // namespace ensemble
