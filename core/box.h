// A box along the axes of its frame.
#pragma once

#include <limits>

#include "core/math.h"

namespace ensemble {

struct Box {
  Vec3 low{std::numeric_limits<float>::max()};
  Vec3 high{std::numeric_limits<float>::lowest()};

  bool empty() const { return low.x > high.x; }
  void add(Vec3 point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  /// Adds a ball. @pre radius >= 0
  void add(Vec3 center, float radius) {
    add(center - Vec3(radius));
    add(center + Vec3(radius));
  }
  /// @pre number < 8
  Vec3 corner(unsigned number) const {
    return {(number & 1u) != 0 ? high.x : low.x, (number & 2u) != 0 ? high.y : low.y,
            (number & 4u) != 0 ? high.z : low.z};
  }
  Vec3 center() const { return 0.5f * (low + high); }
  Vec3 extent() const { return high - low; }
};

}  // namespace ensemble
