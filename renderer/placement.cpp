// The disc is Bridson's "Fast Poisson disk sampling in arbitrary dimensions" (SIGGRAPH sketches
// 2007). Departures: positions are rounded to 32 bits before they are tested, so that the least
// distance holds for what is drawn; directions come from rejection, not from sine and cosine, so
// that the same places come out on every machine; new points are tried nearer to the old ones (67 %
// of a square per person is filled, not 62 %) and around the old ones in turn, not at random, which
// keeps the cells in the cache; the sample is larger than needed and cut to the nearest `count`,
// which leaves a round crowd with exactly that many people.
#include "renderer/placement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/check.h"
#include "core/random.h"
#include "renderer/crowd_streams.h"

namespace ensemble {
namespace {

constexpr double kTwoPi = 6.283185307179586;

float roundedSum(float center, double offset) { return static_cast<float>(center + offset); }

std::uint32_t squareColumns(std::uint32_t count) {
  auto columns = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  return std::max(columns, 1u);
}

class Jitter {
 public:
  Jitter(const ScenePlacement& placement, std::uint64_t seed)
      : x_(seed, crowd_stream::kJitterX),
        z_(seed, crowd_stream::kJitterZ),
        range_(static_cast<double>(placement.jitter) * placement.spacing) {}
  double x(std::uint32_t person) const { return (2.0 * x_.uniform(person) - 1.0) * range_; }
  double z(std::uint32_t person) const { return (2.0 * z_.uniform(person) - 1.0) * range_; }

 private:
  RandomStream x_, z_;
  double range_;
};

/// Ranks of `columns`, in the frame of the placement: x to the side, z to the front.
struct Ranks {
  std::uint32_t columns, rows, count;
  double spacing;

  Ranks(const ScenePlacement& placement, std::uint32_t people) : count(people), spacing(placement.spacing) {
    columns = placement.columns > 0 ? std::min(placement.columns, people) : squareColumns(people);
    rows = (people + columns - 1) / columns;
  }
  double alongRow(std::uint32_t person, std::uint32_t row_length) const {
    return (person % columns - (row_length - 1) * 0.5) * spacing;
  }
  double acrossRows(std::uint32_t person) const { return (person / columns - (rows - 1) * 0.5) * spacing; }
  std::uint32_t rowLength(std::uint32_t person) const {
    return person / columns + 1 < rows ? columns : count - (rows - 1) * columns;
  }
};

void placeGrid(const ScenePlacement& placement, std::uint64_t seed, std::vector<Place>& places) {
  const Ranks ranks(placement, static_cast<std::uint32_t>(places.size()));
  const Jitter jitter(placement, seed);
  for (std::uint32_t i = 0; i < ranks.count; ++i) {
    places[i].position = {roundedSum(placement.center.x, ranks.alongRow(i, ranks.columns) + jitter.x(i)),
                          placement.center.y,
                          roundedSum(placement.center.z, ranks.acrossRows(i) + jitter.z(i))};
  }
}

void placeFormation(const ScenePlacement& placement, std::uint64_t seed, std::vector<Place>& places) {
  const Ranks ranks(placement, static_cast<std::uint32_t>(places.size()));
  const Jitter jitter(placement, seed);
  const double heading = placement.heading.value_or(0.0f);
  const double sine = std::sin(heading), cosine = std::cos(heading);
  for (std::uint32_t i = 0; i < ranks.count; ++i) {
    const double side = ranks.alongRow(i, ranks.rowLength(i)) + jitter.x(i);
    const double front = -ranks.acrossRows(i) + jitter.z(i);
    places[i].position = {roundedSum(placement.center.x, side * cosine + front * sine), placement.center.y,
                          roundedSum(placement.center.z, front * cosine - side * sine)};
  }
}

/// A Poisson-disc sample of a disc, grown from its centre.
class DiscSample {
 public:
  struct Point {
    float x, z;             ///< world
    double squared_radius;  ///< from the centre
  };

  DiscSample(const ScenePlacement& placement, double radius, std::uint64_t seed)
      : center_x_(placement.center.x),
        center_z_(placement.center.z),
        spacing_(placement.spacing),
        squared_spacing_(spacing_ * spacing_),
        radius_(radius),
        cell_(spacing_ / std::sqrt(2.0)),  // at most one point a cell
        random_(seed, crowd_stream::kDisc) {
    const double cells = std::ceil(2.0 * radius / cell_) + 2.0 * kReach + 2.0;
    ENSEMBLE_CHECK(cells < 40'000.0);
    side_ = static_cast<std::int64_t>(cells);
    cells_.assign(static_cast<std::size_t>(side_ * side_), Cell());
  }

  /// Stops when there is no room beside any point, as far as kTries can tell.
  void grow() {
    tryAdd(0.0, 0.0);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      while (addAround(points_[i])) {
      }
    }
  }

  std::vector<Point>& points() { return points_; }

 private:
  /// The point in a cell; where there is none, one that is far from all.
  struct Cell {
    float x = std::numeric_limits<float>::infinity(), z = 0.0f;
  };
  static constexpr std::int64_t kReach = 2;  ///< cells to each side that may hold a point too near
  static constexpr int kTries = 16;          ///< in vain before a point is given up; Bridson: 30
  static constexpr double kSpread = 0.5;     ///< new points are 1 to 1 + this spacings away; Bridson: 1

  /// One more point near `from`, if one is found.
  bool addAround(Point from) {
    for (int i = 0; i < kTries;) {
      const double x = 2.0 * random_.uniform(draw_) - 1.0, z = 2.0 * random_.uniform(draw_ + 1) - 1.0;
      const double squared = x * x + z * z;
      draw_ += 2;
      if (squared > 1.0 || squared < 1e-6) continue;  // a uniform direction
      ++i;
      const double distance = spacing_ * (1.0 + kSpread * random_.uniform(draw_++));
      const double factor = distance / std::sqrt(squared);
      if (tryAdd(from.x - center_x_ + x * factor, from.z - center_z_ + z * factor)) return true;
    }
    return false;
  }

  /// @param offset_x, offset_z from the centre
  bool tryAdd(double offset_x, double offset_z) {
    Point point{static_cast<float>(center_x_ + offset_x), static_cast<float>(center_z_ + offset_z), 0.0};
    const double x = point.x - center_x_, z = point.z - center_z_;
    point.squared_radius = x * x + z * z;
    if (point.squared_radius > radius_ * radius_) return false;
    const std::int64_t column = cellOf(x), row = cellOf(z);
    for (std::int64_t r = row - kReach; r <= row + kReach; ++r) {
      const Cell* const cells = cells_.data() + r * side_;
      for (std::int64_t c = column - kReach; c <= column + kReach; ++c) {
        if (isTooNear(cells[c], point)) return false;
      }
    }
    Cell& cell = cells_[static_cast<std::size_t>(row * side_ + column)];
    if (std::isfinite(cell.x)) return false;
    cell = {point.x, point.z};
    points_.push_back(point);
    return true;
  }

  bool isTooNear(const Cell& a, const Point& b) const {
    const double dx = static_cast<double>(a.x) - b.x, dz = static_cast<double>(a.z) - b.z;
    return dx * dx + dz * dz < squared_spacing_;
  }

  std::int64_t cellOf(double offset) const {
    return static_cast<std::int64_t>(std::floor((offset + radius_) / cell_)) + kReach;
  }

  double center_x_, center_z_, spacing_, squared_spacing_, radius_, cell_;
  RandomStream random_;
  std::uint64_t draw_ = 0;
  std::int64_t side_ = 0;
  std::vector<Cell> cells_;
  std::vector<Point> points_;
};

void placeDisc(const ScenePlacement& placement, std::uint64_t seed, std::vector<Place>& places) {
  const std::size_t count = places.size();
  // A sample has 0.66 to 0.68 points per squared spacing; a little less is counted on.
  constexpr double kDensity = 0.64, kPi64 = kTwoPi / 2.0;
  double radius = placement.spacing * (std::sqrt(static_cast<double>(count) / (kDensity * kPi64)) + 0.5);
  for (int attempt = 0; attempt < 8; ++attempt, radius *= 1.1) {
    DiscSample sample(placement, radius, seed);
    sample.grow();
    std::vector<DiscSample::Point>& points = sample.points();
    if (points.size() < count) continue;
    // Stable: equal radii stay in the order of growth.
    std::stable_sort(points.begin(), points.end(),
                     [](const DiscSample::Point& a, const DiscSample::Point& b) {
                       return a.squared_radius < b.squared_radius;
                     });
    for (std::size_t i = 0; i < count; ++i) {
      places[i].position = {points[i].x, placement.center.y, points[i].z};
    }
    return;
  }
  throw std::length_error("no room for so many people at this spacing");
}

void turn(const ScenePlacement& placement, std::uint64_t seed, std::vector<Place>& places) {
  const RandomStream random(seed, crowd_stream::kHeading);
  const bool is_random = !placement.heading && placement.kind != PlacementKind::kFormation;
  const double middle = placement.heading.value_or(0.0f);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double u = random.uniform(i);
    places[i].heading = static_cast<float>(
        is_random ? u * kTwoPi : middle + (2.0 * u - 1.0) * static_cast<double>(placement.heading_spread));
  }
}

}  // namespace

std::vector<Place> placePeople(const ScenePlacement& placement, std::uint32_t count, std::uint64_t seed) {
  ENSEMBLE_CHECK(placement.spacing > 0.0f);
  ENSEMBLE_CHECK(placement.jitter >= 0.0f && placement.jitter <= 0.45f);
  std::vector<Place> places(count);
  if (count == 0) return places;
  switch (placement.kind) {
    case PlacementKind::kGrid:
      placeGrid(placement, seed, places);
      break;
    case PlacementKind::kDisc:
      placeDisc(placement, seed, places);
      break;
    case PlacementKind::kFormation:
      placeFormation(placement, seed, places);
      break;
    case PlacementKind::kTable:
      for (Place& place : places) place.position = placement.center;
      break;
    case PlacementKind::kPaths:
    case PlacementKind::kFile:
      ENSEMBLE_CHECK(!"people who walk are placed by crowd_walkers.h");
  }
  turn(placement, seed, places);
  return places;
}

}  // namespace ensemble
