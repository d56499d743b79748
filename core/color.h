// Colours.
#pragma once

#include "core/math.h"

namespace ensemble {

/// The transfer functions of sRGB (IEC 61966-2-1), for one channel of 0 .. 1.
float linearFromSrgb(float srgb);
float srgbFromLinear(float linear);

/// Linear colour of an sRGB one, each 0 .. 1.
Vec3 linearFromSrgb(const Vec3& srgb);

}  // namespace ensemble
