#include "renderer/tile_grid.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/check.h"

namespace ensemble {
namespace {

TEST(TileGrid, CoversEveryPixelOnce) {
  struct Case {
    std::uint32_t width, height;
    TileLimits limits;
  };
  for (const Case& c :
       {Case{160, 120, {64, 64 * 64}}, Case{1, 1, {1, 1}}, Case{5, 3, {1, 1}}, Case{100, 7, {99, 99}},
        Case{9, 9, {4, 8}}, Case{17, 33, {5, 100}}, Case{64, 64, {64, 4096}}, Case{6, 200, {64, 64}}}) {
    const TileGrid grid(c.width, c.height, c.limits);
    EXPECT_LE(std::uint64_t{grid.tileWidth()} * grid.tileHeight(), c.limits.pixels);
    std::vector<int> seen(c.width * c.height);
    for (std::uint32_t i = 0; i < grid.count(); ++i) {
      const Tile tile = grid[i];
      EXPECT_GT(tile.width, 0u);
      EXPECT_GT(tile.height, 0u);
      EXPECT_LE(tile.width, std::min(grid.tileWidth(), c.limits.side));
      EXPECT_LE(tile.height, std::min(grid.tileHeight(), c.limits.side));
      for (std::uint32_t y = tile.y; y < tile.y + tile.height; ++y) {
        for (std::uint32_t x = tile.x; x < tile.x + tile.width; ++x) ++seen.at(y * c.width + x);
      }
    }
    EXPECT_EQ(seen, std::vector<int>(seen.size(), 1)) << c.width << " x " << c.height;
  }
}

TEST(TileGrid, LeavesOrdinaryPicturesWhole) {
  EXPECT_EQ(TileGrid(3840, 2160, {}).count(), 1u);
  EXPECT_EQ(TileGrid(2160, 3840, {}).count(), 1u);
  EXPECT_EQ(TileGrid(4096, 2304, {})[0], (Tile{0, 0, 4096, 2304}));
  EXPECT_EQ(TileGrid(7680, 4320, {}).count(), 4u);
  EXPECT_EQ(TileGrid(7680, 4320, {})[3], (Tile{3840, 2160, 3840, 2160}));
  EXPECT_EQ(TileGrid(2560, 1440, {}, 4).count(), 1u);
  EXPECT_EQ(TileGrid(3840, 2160, {}, 4).count(), 2u);
  EXPECT_EQ(TileGrid(3840, 2160, {}, 4)[1], (Tile{0, 1080, 3840, 1080}));
  const TileGrid largest(16384, 16384, {});
  EXPECT_EQ(largest.count(), 32u);
  EXPECT_EQ(largest[31], (Tile{12288, 14336, 4096, 2048}));
}

TEST(TileGrid, ChecksItsCaller) {
  EXPECT_THROW(TileGrid(0, 1, {}), CheckError);
  EXPECT_THROW(TileGrid(1, 1, {0, 1}), CheckError);
  EXPECT_THROW(TileGrid(1, 1, {8, 7}), CheckError);
}

}  // namespace
}  // namespace ensemble
