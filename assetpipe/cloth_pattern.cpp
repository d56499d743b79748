#include "assetpipe/cloth_pattern.h"

#include <cmath>

#include "core/image_file.h"

namespace ensemble {
namespace {

constexpr std::uint32_t kSize = 64;

/// How much of the second colour there is at a place of the repeat, 0 to 1 each way.
float shareAt(PatternKind kind, float u, float v) {
  switch (kind) {
    case PatternKind::kNone:
      return 0.0f;
    case PatternKind::kStripes:
      return v < 0.5f ? 0.0f : 1.0f;
    case PatternKind::kPinstripes:
      return u < 0.1f ? 1.0f : 0.0f;
    case PatternKind::kChecks:
      return (u < 0.35f ? 0.5f : 0.0f) + (v < 0.35f ? 0.5f : 0.0f);
    case PatternKind::kDots:
      return std::hypot(u - 0.5f, v - 0.5f) < 0.27f ? 1.0f : 0.0f;
    case PatternKind::kKnit: {
      // Two columns of stitches, each a V.
      const float column = std::abs(std::fmod(2.0f * u, 1.0f) - 0.5f);
      const float row = std::fmod(2.0f * v + column, 1.0f);
      return 0.5f + 0.5f * std::cos(2.0f * kPi * row) * (column < 0.45f ? 1.0f : 0.3f);
    }
  }
  return 0.0f;
}

}  // namespace

RawImage patternImage(const std::string& name, const Vec3& srgb, const Pattern& pattern) {
  Image8 pixels;
  pixels.width = pixels.height = kSize;
  for (std::uint32_t y = 0; y < kSize; ++y) {
    for (std::uint32_t x = 0; x < kSize; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / kSize, v = (static_cast<float>(y) + 0.5f) / kSize;
      const Vec3 color = glm::mix(srgb, pattern.color, shareAt(pattern.kind, u, v));
      for (int c = 0; c < 3; ++c)
        pixels.rgba.push_back(static_cast<std::uint8_t>(std::lround(color[c] * 255.0f)));
      pixels.rgba.push_back(255);
    }
  }
  RawImage image;
  image.name = name;
  image.mime_type = "image/png";
  image.bytes = encodePng(pixels);
  image.width = image.height = kSize;
  return image;
}

}  // namespace ensemble
