#include "renderer/journey.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace ensemble {
namespace {

constexpr double kStandingDistance = 1e-9;  // metres: two knots this near are a stand

/// Adds the knots of a way from standing (or walking) to standing (or walking): constant
/// acceleration, speed, deceleration. A short way never reaches the speed.
class KnotBuilder {
 public:
  KnotBuilder(double speed, double acceleration) : speed_(speed), acceleration_(acceleration) {}

  void walk(double length, bool from_stand, bool to_stand) {
    if (knots_.empty()) knots_.push_back({0.0, 0.0, from_stand ? 0.0 : speed_});
    const double ramps = (from_stand ? 1.0 : 0.0) + (to_stand ? 1.0 : 0.0);
    const double ramp_length = 0.5 * speed_ * speed_ / acceleration_;
    const double top =
        ramps > 0.0 ? std::min(speed_, std::sqrt(2.0 * acceleration_ * length / ramps)) : speed_;
    const double ramp = std::min(ramp_length, ramps > 0.0 ? length / ramps : ramp_length);
    if (from_stand) advance(ramp, top, 2.0 * ramp / top);
    const double cruise = length - ramps * ramp;
    if (cruise > 1e-9) advance(cruise, top, cruise / top);
    if (to_stand) advance(ramp, 0.0, 2.0 * ramp / top);
  }
  void stand(double seconds) { advance(0.0, 0.0, seconds); }

  std::vector<Journey::Knot> take() { return std::move(knots_); }

 private:
  void advance(double distance, double speed, double seconds) {
    knots_.push_back({knots_.back().seconds + seconds, knots_.back().distance + distance, speed});
  }
  double speed_, acceleration_;
  std::vector<Journey::Knot> knots_;
};

}  // namespace

Journey::Journey(Route route, std::vector<Knot> knots, Repeat repeat, double origin)
    : route_(std::move(route)), knots_(std::move(knots)), repeat_(repeat), origin_(origin) {
  ENSEMBLE_CHECK(knots_.size() >= 2u);
  ENSEMBLE_CHECK(knots_.front().seconds == 0.0);
  std::size_t first = 0;
  bool stood = false;
  for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
    ENSEMBLE_CHECK(knots_[i + 1].seconds > knots_[i].seconds);
    const bool stands = knots_[i + 1].distance - knots_[i].distance < kStandingDistance;
    if (!stands) continue;
    // A stand at the very begin has a stretch of no length before it, so that it has a stretch at all.
    if (i > first || stretches_.empty())
      stretches_.push_back({first, i, stood || knots_[first].speed == 0.0, true});
    first = i + 1;
    stood = true;
  }
  if (first + 1 < knots_.size() || stretches_.empty()) {
    stretches_.push_back({first, knots_.size() - 1, stood || knots_[first].speed == 0.0, false});
  }
}

Journey Journey::withStops(Route route, double speed, double acceleration, std::span<const Stop> stops) {
  ENSEMBLE_CHECK(speed > 0.0);
  ENSEMBLE_CHECK(acceleration > 0.0);
  KnotBuilder builder(speed, acceleration);
  const double length = route.length();
  const Repeat repeat = route.closed() ? Repeat::kRoundTheLoop : Repeat::kFromStart;
  if (stops.empty()) {
    builder.walk(length, false, false);
    return Journey(std::move(route), builder.take(), repeat);
  }
  const bool closed = route.closed();
  double at = closed ? stops[0].distance : 0.0;
  for (std::size_t i = closed ? 1 : 0; i < stops.size(); ++i) {
    builder.walk(stops[i].distance - at, i > 0, true);
    builder.stand(stops[i].seconds);
    at = stops[i].distance;
  }
  if (closed) {
    builder.walk(stops[0].distance + length - at, true, true);
    builder.stand(stops[0].seconds);
    return Journey(std::move(route), builder.take(), repeat, stops[0].distance);
  }
  if (length > at) builder.walk(length - at, true, false);
  return Journey(std::move(route), builder.take(), repeat);
}

Journey::Moment Journey::at(double seconds) const {
  Moment moment;
  if (repeat_ == Repeat::kNever) {
    moment.exists = seconds >= 0.0 && seconds <= knots_.back().seconds;
    seconds = std::clamp(seconds, 0.0, knots_.back().seconds);
  } else {
    const double laps = std::floor(seconds / knots_.back().seconds);
    seconds = std::clamp(seconds - laps * knots_.back().seconds, 0.0, knots_.back().seconds);
    moment.lap = static_cast<std::int64_t>(laps);
  }
  const auto later = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, seconds,
                                      [](double s, const Knot& knot) { return s < knot.seconds; });
  const Knot &from = *(later - 1), &to = *later;
  // Cubic Hermite: exact where the acceleration is constant.
  const double step = to.seconds - from.seconds, u = (seconds - from.seconds) / step;
  const double rise = to.distance - from.distance;
  const double a = from.speed * step + to.speed * step - 2.0 * rise;
  const double b = 3.0 * rise - 2.0 * from.speed * step - to.speed * step;
  moment.distance = from.distance + u * (from.speed * step + u * (b + u * a));
  moment.speed = std::max(0.0, from.speed + u * (2.0 * b + 3.0 * u * a) / step);
  if (rise < kStandingDistance) {
    moment.distance = from.distance;
    moment.speed = 0.0;
  }
  const auto knot = static_cast<std::size_t>(later - knots_.begin()) - 1;
  while (moment.stretch + 1 < stretches_.size() && stretches_[moment.stretch + 1].first_knot <= knot) {
    ++moment.stretch;
  }
  return moment;
}

}  // namespace ensemble
