// A ball that holds a person.
#pragma once

#include "core/math.h"

namespace ensemble {

struct Sphere {
  Vec3 center{0.0f};
  float radius = 0.0f;
};

}  // namespace ensemble
