#include "core/color.h"

#include <cmath>

namespace ensemble {

Vec3 linearFromSrgb(const Vec3& srgb) {
  Vec3 linear;
  for (int i = 0; i < 3; ++i) {
    linear[i] = srgb[i] <= 0.04045f ? srgb[i] / 12.92f : std::pow((srgb[i] + 0.055f) / 1.055f, 2.4f);
  }
  return linear;
}

}  // namespace ensemble
