#include "renderer/route.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace ensemble {
namespace {

constexpr float kArcStep = 0.05f;  // radians between the knots of an arc

float headingOf(Vec3 way) { return std::atan2(way.x, way.z); }
Vec3 alongHeading(float heading) { return {std::sin(heading), 0.0f, std::cos(heading)}; }
Vec3 leftOf(float heading) { return {std::cos(heading), 0.0f, -std::sin(heading)}; }

/// `angle` plus a whole number of turns, as near to `reference` as can be.
float unwrapped(float angle, float reference) {
  return angle + 2.0f * kPi * std::round((reference - angle) / (2.0f * kPi));
}

}  // namespace

void Route::add(Vec3 position, float heading, float curvature) {
  Knot knot{.distance = 0.0, .position = position, .heading = heading, .curvature = curvature};
  if (!knots_.empty()) {
    const Knot& last = knots_.back();
    const double step = glm::distance(glm::dvec3(last.position), glm::dvec3(position));
    knot.heading = unwrapped(heading, last.heading);
    if (step < 1e-6) {  // the same place: the later one knows what follows
      knots_.back().curvature = curvature;
      return;
    }
    knot.distance = last.distance + step;
  }
  knots_.push_back(knot);
}

void Route::addArc(Vec3 from, Vec3 corner, Vec3 to, float radius) {
  const Vec3 in = corner - from, out = to - corner;
  const float turn = unwrapped(headingOf(out), headingOf(in)) - headingOf(in);
  const float half = 0.5f * std::abs(turn);
  const float room = 0.5f * std::min(glm::length(in), glm::length(out));
  const float tangent = std::min(radius * std::tan(std::min(half, 1.5f)), room);
  const float arc_radius = tangent / std::max(std::tan(std::min(half, 1.5f)), 1e-6f);
  if (half < 1e-4f || tangent < 1e-4f) return add(corner, headingOf(out), 0.0f);
  const float sign = turn > 0.0f ? 1.0f : -1.0f;
  const Vec3 begin = corner - glm::normalize(in) * tangent, end = corner + glm::normalize(out) * tangent;
  const Vec3 center = begin + sign * arc_radius * leftOf(headingOf(in));
  const int steps = std::max(2, static_cast<int>(std::ceil(std::abs(turn) / kArcStep)));
  for (int i = 0; i <= steps; ++i) {
    const float part = static_cast<float>(i) / static_cast<float>(steps);
    const float heading = headingOf(in) + part * turn;
    Vec3 position = center - sign * arc_radius * leftOf(heading);
    position.y = glm::mix(begin.y, end.y, part);
    add(position, heading, i < steps ? sign / arc_radius : 0.0f);
  }
}

Route Route::throughWaypoints(std::span<const Vec3> points, bool closed, float corner_radius) {
  ENSEMBLE_CHECK(points.size() >= (closed ? 3u : 2u));
  Route route;
  route.closed_ = closed;
  const std::size_t count = points.size();
  if (closed) {
    // Begin in the middle of a side, where there is no corner.
    const Vec3 start = 0.5f * (points[count - 1] + points[0]);
    const float heading = headingOf(points[0] - points[count - 1]);
    route.add(start, heading, 0.0f);
    for (std::size_t i = 0; i < count; ++i) {
      route.addArc(points[(i + count - 1) % count], points[i], points[(i + 1) % count], corner_radius);
    }
    route.add(start, heading, 0.0f);
    return route;
  }
  route.add(points[0], headingOf(points[1] - points[0]), 0.0f);
  for (std::size_t i = 1; i + 1 < count; ++i)
    route.addArc(points[i - 1], points[i], points[i + 1], corner_radius);
  route.add(points[count - 1], headingOf(points[count - 1] - points[count - 2]), 0.0f);
  return route;
}

Route Route::alongPoints(std::span<const Vec3> points) {
  ENSEMBLE_CHECK(!points.empty());
  Route route;
  if (points.size() == 1) {
    route.add(points[0], 0.0f, 0.0f);
    route.add(points[0] + Vec3(0.0f, 0.0f, 1e-3f), 0.0f, 0.0f);
    return route;
  }
  route.add(points[0], headingOf(points[1] - points[0]), 0.0f);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    route.add(0.5f * (points[i] + points[i + 1]), headingOf(points[i + 1] - points[i]), 0.0f);
    if (i + 2 < points.size()) {
      const float in = headingOf(points[i + 1] - points[i]);
      const float out = unwrapped(headingOf(points[i + 2] - points[i + 1]), in);
      route.add(points[i + 1], 0.5f * (in + out), 0.0f);
    }
  }
  route.add(points.back(), headingOf(points.back() - points[points.size() - 2]), 0.0f);
  return route;
}

bool Route::fits(float offset) const {
  return std::all_of(knots_.begin(), knots_.end(),
                     [&](const Knot& knot) { return 1.0f - offset * knot.curvature > 0.05f; });
}

Route Route::beside(float offset) const {
  ENSEMBLE_CHECK(fits(offset));
  Route route;
  route.closed_ = closed_;
  for (const Knot& knot : knots_) {
    route.add(knot.position + offset * leftOf(knot.heading), knot.heading,
              knot.curvature / (1.0f - offset * knot.curvature));
  }
  return route;
}

Route::At Route::at(double distance) const {
  const double whole = length();
  float turned = 0.0f;
  if (closed_) {
    const double laps = std::floor(distance / whole);
    distance -= laps * whole;
    turned = static_cast<float>(std::fmod(laps, 1e6)) * (knots_.back().heading - knots_.front().heading);
  }
  if (distance <= 0.0 || distance >= whole) {
    const Knot& end = distance <= 0.0 ? knots_.front() : knots_.back();
    const auto beyond = static_cast<float>(distance - end.distance);
    return {end.position + beyond * alongHeading(end.heading), end.heading + turned};
  }
  const auto next = std::upper_bound(knots_.begin(), knots_.end(), distance,
                                     [](double d, const Knot& knot) { return d < knot.distance; });
  const Knot &from = *(next - 1), &to = *next;
  const auto part = static_cast<float>((distance - from.distance) / (to.distance - from.distance));
  return {glm::mix(from.position, to.position, part), glm::mix(from.heading, to.heading, part) + turned};
}

}  // namespace ensemble
