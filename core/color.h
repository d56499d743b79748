// Colours.
#pragma once

#include "core/math.h"

namespace ensemble {

/// Linear colour of an sRGB one, each 0 .. 1.
Vec3 linearFromSrgb(const Vec3& srgb);

}  // namespace ensemble
