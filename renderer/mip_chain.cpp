#include "renderer/mip_chain.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/check.h"
#include "core/color.h"

namespace ensemble {
namespace {

const std::array<float, 256>& linearTable() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = linearFromSrgb(static_cast<float>(i) / 255.0f);
    return values;
  }();
  return table;
}

/// The sRGB byte of a linear value in 16 bits: fine enough, the darkest step of sRGB is 20 of these.
const std::vector<std::uint8_t>& srgbTable() {
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> values(65536);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] =
          static_cast<std::uint8_t>(std::lround(srgbFromLinear(static_cast<float>(i) / 65535.0f) * 255.0f));
    }
    return values;
  }();
  return table;
}

std::uint8_t toByte(float value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

std::uint8_t toSrgbByte(float linear) {
  return srgbTable()[static_cast<std::size_t>(std::clamp(linear, 0.0f, 1.0f) * 65535.0f + 0.5f)];
}

/// Linear colour times alpha, and alpha, with the plain sum of colours in case all alphas are 0.
struct Sum {
  Vec3 premultiplied{0.0f}, plain{0.0f};
  float alpha = 0.0f, weight = 0.0f;

  void add(const std::uint8_t* rgba, float share) {
    const std::array<float, 256>& table = linearTable();
    const Vec3 color(table[rgba[0]], table[rgba[1]], table[rgba[2]]);
    const float a = static_cast<float>(rgba[3]) / 255.0f;
    premultiplied += color * (a * share);
    plain += color * share;
    alpha += a * share;
    weight += share;
  }
  void write(std::uint8_t* rgba) const {
    const Vec3 color = alpha > 0.0f ? premultiplied / alpha : plain / weight;
    for (int i = 0; i < 3; ++i) rgba[i] = toSrgbByte(color[i]);
    rgba[3] = toByte(alpha / weight);
  }
};

/// The source texels under a target texel along one axis, with their shares.
struct Taps {
  std::vector<std::uint32_t> texels;
  std::vector<float> shares;
};

Taps tapsOf(std::uint32_t target, std::uint32_t target_count, std::uint32_t count) {
  Taps taps;
  const double scale = static_cast<double>(count) / target_count;
  if (scale <= 1.0) {  // Grows: between the two nearest centres, repeating at the border.
    const double at = (target + 0.5) * scale - 0.5;
    const double low = std::floor(at);
    const auto wrap = [&](double texel) {
      const auto n = static_cast<std::int64_t>(count);
      return static_cast<std::uint32_t>(((static_cast<std::int64_t>(texel) % n) + n) % n);
    };
    taps.texels = {wrap(low), wrap(low + 1.0)};
    taps.shares = {static_cast<float>(1.0 - (at - low)), static_cast<float>(at - low)};
    return taps;
  }
  const double from = target * scale, to = (target + 1) * scale;
  for (auto texel = static_cast<std::uint32_t>(from); texel < count && texel < to; ++texel) {
    const double share = std::min(to, texel + 1.0) - std::max(from, static_cast<double>(texel));
    taps.texels.push_back(texel);
    taps.shares.push_back(static_cast<float>(share));
  }
  return taps;
}

std::vector<std::uint8_t> resized(const Image8& image, std::uint32_t side) {
  if (image.width == side && image.height == side) return image.rgba;
  std::vector<Taps> columns;
  for (std::uint32_t x = 0; x < side; ++x) columns.push_back(tapsOf(x, side, image.width));
  std::vector<std::uint8_t> texels(std::size_t{4} * side * side);
  for (std::uint32_t y = 0; y < side; ++y) {
    const Taps rows = tapsOf(y, side, image.height);
    for (std::uint32_t x = 0; x < side; ++x) {
      const Taps& taps = columns[x];
      Sum sum;
      for (std::size_t j = 0; j < rows.texels.size(); ++j) {
        for (std::size_t i = 0; i < taps.texels.size(); ++i) {
          const std::size_t texel = std::size_t{rows.texels[j]} * image.width + taps.texels[i];
          sum.add(image.rgba.data() + 4 * texel, rows.shares[j] * taps.shares[i]);
        }
      }
      sum.write(texels.data() + 4 * (std::size_t{y} * side + x));
    }
  }
  return texels;
}

std::vector<std::uint8_t> halved(const std::vector<std::uint8_t>& texels, std::uint32_t side) {
  const std::uint32_t half = side / 2;
  std::vector<std::uint8_t> result(std::size_t{4} * half * half);
  for (std::uint32_t y = 0; y < half; ++y) {
    for (std::uint32_t x = 0; x < half; ++x) {
      Sum sum;
      const std::uint8_t* corner = texels.data() + 4 * (std::size_t{2} * y * side + 2 * x);
      for (const std::size_t offset : {0u, 4u, 4 * side, 4 * side + 4}) sum.add(corner + offset, 1.0f);
      sum.write(result.data() + 4 * (std::size_t{y} * half + x));
    }
  }
  return result;
}

}  // namespace

std::vector<std::vector<std::uint8_t>> mipChain(const Image8& image, std::uint32_t side) {
  ENSEMBLE_CHECK(std::has_single_bit(side));
  ENSEMBLE_CHECK(image.width > 0 && image.height > 0);
  std::vector<std::vector<std::uint8_t>> levels{resized(image, side)};
  for (; side > 1; side /= 2) levels.push_back(halved(levels.back(), side));
  return levels;
}

Vec3 meanColor(const Image8& image) {
  glm::dvec3 color(0.0);
  double alpha = 0.0;
  for (std::uint32_t y = 0; y < image.height; ++y) {
    Sum row;
    for (std::uint32_t x = 0; x < image.width; ++x) {
      row.add(image.rgba.data() + 4 * (std::size_t{y} * image.width + x), 1.0f);
    }
    color += glm::dvec3(row.premultiplied);
    alpha += static_cast<double>(row.alpha);
  }
  return alpha > 0.0 ? Vec3(color / alpha) : Vec3(0.5f);
}

}  // namespace ensemble
