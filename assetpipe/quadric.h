// Quadric error metrics: M. Garland and P. Heckbert, "Surface Simplification Using Quadric Error Metrics",
// SIGGRAPH 1997.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/math.h"

namespace ensemble {

/// Sum of squared distances to planes, weighted: x^T A x + 2 b x + c.
struct Quadric {
  std::array<double, 6> a{};
  glm::dvec3 b{0.0};
  double c = 0.0;

  /// @param normal of length 1
  void addPlane(const glm::dvec3& normal, const glm::dvec3& point, double weight) {
    const double d = -glm::dot(normal, point);
    a[0] += weight * normal.x * normal.x;
    a[1] += weight * normal.x * normal.y;
    a[2] += weight * normal.x * normal.z;
    a[3] += weight * normal.y * normal.y;
    a[4] += weight * normal.y * normal.z;
    a[5] += weight * normal.z * normal.z;
    b += normal * (d * weight);
    c += d * d * weight;
  }
  void add(const Quadric& other) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += other.a[i];
    b += other.b;
    c += other.c;
  }
  double at(const glm::dvec3& p) const {
    const double value = a[0] * p.x * p.x + 2 * a[1] * p.x * p.y + 2 * a[2] * p.x * p.z + a[3] * p.y * p.y +
                         2 * a[4] * p.y * p.z + a[5] * p.z * p.z + 2 * glm::dot(b, p) + c;
    return std::max(value, 0.0);
  }
};

}  // namespace ensemble
