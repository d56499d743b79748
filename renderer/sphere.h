// A ball that holds a person.
#pragma once

#include "core/math.h"

namespace ensemble {

struct Sphere {
  Vec3 center{0.0f};
  float radius = 0.0f;
};

/// The radius of somebody who is not there: it touches nothing, and products with it stay finite.
inline constexpr float kTouchesNothing = -1e30f;

}  // namespace ensemble
