// When somebody is where along a route: walking at a speed, slowing down, standing, going on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/route.h"

namespace ensemble {

/// Distance as a function of time, in stretches with a stand between any two. Distances never
/// decrease. Shared by all who walk the same route in the same way, one after the other.
class Journey {
 public:
  /// A time at which distance and speed are known; between two the distance is a cubic.
  struct Knot {
    double seconds = 0.0, distance = 0.0;
    double speed = 0.0;  ///< metres a second
  };
  /// A way from stand to stand. Its ends are knots.
  struct Stretch {
    std::size_t first_knot = 0, last_knot = 0;
    bool begins_standing = false, ends_standing = false;
  };
  /// Where on the journey somebody is.
  struct Moment {
    std::size_t stretch = 0;
    double distance = 0.0;
    double speed = 0.0;
    std::int64_t lap = 0;  ///< how often the journey has been done before; `distance` is of this lap
    bool exists = true;    ///< false before the begin and after the end of a journey that happens once
  };

  enum class Repeat : std::uint8_t { kNever, kFromStart, kRoundTheLoop };

  /// @param knots ascending in seconds, beginning at 0; two neighbours of one distance are a stand
  /// @param origin where on the route the journey's distance 0 is, metres
  Journey(Route route, std::vector<Knot> knots, Repeat repeat, double origin = 0.0);

  /// Walks a route at `speed`, standing `seconds` at each of the stops (distances ascending).
  struct Stop {
    double distance = 0.0, seconds = 0.0;
  };
  /// A closed route with stops begins at the first of them.
  /// @param acceleration metres a second squared, after and before a stand
  static Journey withStops(Route route, double speed, double acceleration, std::span<const Stop> stops);

  /// The place at a distance of the journey; beyond its ends too.
  Route::At placeAt(double distance) const { return route_.at(origin_ + distance); }
  const std::vector<Stretch>& stretches() const { return stretches_; }
  double beginOf(const Stretch& stretch) const { return knots_[stretch.first_knot].distance; }
  double endOf(const Stretch& stretch) const { return knots_[stretch.last_knot].distance; }
  double seconds() const { return knots_.back().seconds; }  ///< once through
  Repeat repeat() const { return repeat_; }

  Moment at(double seconds) const;

 private:
  Route route_;
  std::vector<Knot> knots_;
  std::vector<Stretch> stretches_;
  Repeat repeat_ = Repeat::kNever;
  double origin_ = 0.0;
};

}  // namespace ensemble
