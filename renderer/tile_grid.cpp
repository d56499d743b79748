#include "renderer/tile_grid.h"

#include <algorithm>

#include "core/check.h"

namespace ensemble {

TileGrid::TileGrid(std::uint32_t width, std::uint32_t height, const TileLimits& limits, std::uint32_t samples)
    : width_(width), height_(height) {
  ENSEMBLE_CHECK(width > 0u && height > 0u && samples > 0u);
  ENSEMBLE_CHECK(limits.side > 0u && limits.pixels >= limits.side);
  const std::uint32_t pixels = std::max(limits.side, std::min(limits.pixels, limits.samples / samples));
  const auto split = [](std::uint32_t length, std::uint32_t most) { return (length - 1) / most + 1; };
  columns_ = split(width_, limits.side);
  tile_width_ = split(width_, columns_);
  rows_ = split(height_, std::min(limits.side, pixels / tile_width_));
  tile_height_ = split(height_, rows_);
  // Rounded up, the last ones may not be needed.
  columns_ = split(width_, tile_width_);
  rows_ = split(height_, tile_height_);
}

Tile TileGrid::operator[](std::uint32_t i) const {
  const std::uint32_t x = i % columns_ * tile_width_, y = i / columns_ * tile_height_;
  return {x, y, std::min(tile_width_, width_ - x), std::min(tile_height_, height_ - y)};
}

}  // namespace ensemble
