#include "core/color.h"

#include <cmath>

namespace ensemble {

float linearFromSrgb(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

float srgbFromLinear(float linear) {
  return linear <= 0.0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

Vec3 linearFromSrgb(const Vec3& srgb) {
  return {linearFromSrgb(srgb.x), linearFromSrgb(srgb.y), linearFromSrgb(srgb.z)};
}

}  // namespace ensemble
