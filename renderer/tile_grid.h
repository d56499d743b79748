// The tiles of pictures that are too large to be drawn at once. No Vulkan.
#pragma once

#include <cstdint>

namespace ensemble {

/// A part of a picture; pixels from the top left.
struct Tile {
  std::uint32_t x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Tile&) const = default;
};

/// How large a tile may be. Every Vulkan device has images of 4096 x 4096.
struct TileLimits {
  std::uint32_t side = 4096;
  std::uint32_t pixels = 4096 * 2304;  ///< at least `side`; 4K is one tile at one sample
  /// Of all pixels: at 8 bytes each the 128 MiB that a buffer may have on every Vulkan device, so that the
  /// compute rasteriser can draw any picture.
  std::uint32_t samples = 4096 * 4096;
};

/// Tiles of one size over a picture, those of the last column and row cut off at its edges. They follow
/// from the picture's size, its samples and the limits alone, never from the device.
class TileGrid {
 public:
  /// @param samples of a pixel @pre width, height and samples are not 0
  TileGrid(std::uint32_t width, std::uint32_t height, const TileLimits& limits, std::uint32_t samples = 1);

  std::uint32_t tileWidth() const { return tile_width_; }
  std::uint32_t tileHeight() const { return tile_height_; }
  std::uint32_t count() const { return columns_ * rows_; }
  Tile operator[](std::uint32_t i) const;  ///< row by row. @pre i < count()

 private:
  std::uint32_t width_, height_, tile_width_, tile_height_, columns_, rows_;
};

}  // namespace ensemble
