// A line over the ground that people walk along, by arc length.
#pragma once

#include <span>
#include <vector>

#include "core/math.h"

namespace ensemble {

class Route {
 public:
  /// A place on the route and the direction of travel.
  struct At {
    Vec3 position{0.0f};
    float heading = 0.0f;  ///< radians about +Y, 0 along +Z
  };

  /// Through waypoints, corners rounded by arcs.
  /// @param points two at least (three where closed), neighbours apart
  /// @param corner_radius metres, of every corner that has room for it; smaller where there is less
  static Route throughWaypoints(std::span<const Vec3> points, bool closed, float corner_radius);
  /// Along points as they are (a recorded trajectory), headings those of the lines between them,
  /// turned evenly from the middle of one to the middle of the next.
  static Route alongPoints(std::span<const Vec3> points);

  /// The route beside this one, `offset` metres to the left of the direction of travel.
  /// @pre fits(offset)
  Route beside(float offset) const;
  /// Whether every arc is wide enough for a route beside it: |offset| < its radius on the inner side.
  bool fits(float offset) const;

  double length() const { return knots_.back().distance; }
  bool closed() const { return closed_; }
  /// Any distance: a closed route goes round, an open one goes on straight before and behind.
  At at(double distance) const;

 private:
  struct Knot {
    double distance = 0.0;
    Vec3 position{0.0f};
    float heading = 0.0f;    // unwrapped: neighbours differ by what is turned between them
    float curvature = 0.0f;  // of what follows: radians a metre, left is positive
  };
  void add(Vec3 position, float heading, float curvature);
  void addArc(Vec3 from, Vec3 corner, Vec3 to, float radius);

  std::vector<Knot> knots_;  // a closed route ends where it begins
  bool closed_ = false;
};

}  // namespace ensemble
