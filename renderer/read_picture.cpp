#include "renderer/read_picture.h"

#include <cstring>
#include <span>
#include <vector>

namespace ensemble {
namespace {

/// The rows of a tile from its target, which may be larger: calls take(first pixel in the picture, bytes).
template <class Take>
void forEachTileRow(const Readback& readback, const View& view, const Tile& tile, const Take& take) {
  readback.forEachRow([&](std::uint32_t row, std::span<const std::byte> bytes) {
    if (row < tile.height) take(std::size_t{tile.y + row} * view.width + tile.x, bytes);
  });
}

/// `count` values of a pixel, which the target has side by side.
template <class T>
void readValues(const Readback& readback, const View& view, const Tile& tile, std::size_t count,
                std::vector<T>& values) {
  values.resize(count * view.width * view.height);
  forEachTileRow(readback, view, tile, [&](std::size_t first, std::span<const std::byte> bytes) {
    std::memcpy(values.data() + count * first, bytes.data(), count * tile.width * sizeof(T));
  });
}

/// RGBA32F to three floats a pixel.
void readNormals(const Readback& readback, const View& view, const Tile& tile, std::vector<float>& values) {
  values.resize(std::size_t{3} * view.width * view.height);
  forEachTileRow(readback, view, tile, [&](std::size_t first, std::span<const std::byte> bytes) {
    float* to = values.data() + 3 * first;
    for (std::uint32_t x = 0; x < tile.width; ++x) {
      std::memcpy(to + std::size_t{3} * x, bytes.data() + std::size_t{16} * x, 3 * sizeof(float));
    }
  });
}

}  // namespace

void readColor(const ViewTargets& targets, const View& view, Picture& picture) {
  picture.color.width = view.width;
  picture.color.height = view.height;
  readValues(targets.readback, view, targets.tile, 4, picture.color.rgba);
  if (view.linear) {
    readValues(targets.linear_readback, view, targets.tile, 4, picture.linear);
  } else {
    picture.linear.clear();
  }
}

void readAovs(const ViewTargets& targets, const View& view, Picture& picture) {
  const auto readback = [&](Aov aov) -> const Readback& {
    return targets.aov_readbacks[static_cast<std::size_t>(aov)];
  };
  const auto read = [&](Aov aov, auto& values) {
    if (view.aovs.has(aov)) {
      readValues(readback(aov), view, targets.tile, 1, values);
    } else {
      values.clear();
    }
  };
  read(Aov::kCharacter, picture.character);
  read(Aov::kRegion, picture.region);
  read(Aov::kFace, picture.face);
  read(Aov::kDepth, picture.depth);
  if (view.aovs.has(Aov::kNormal)) {
    readNormals(readback(Aov::kNormal), view, targets.tile, picture.normal);
  } else {
    picture.normal.clear();
  }
}

}  // namespace ensemble
