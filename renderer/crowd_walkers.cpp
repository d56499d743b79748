#include "renderer/crowd_walkers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/random.h"
#include "renderer/crowd_streams.h"

namespace ensemble {
namespace {

constexpr float kSpeedSpread = 0.05f;     // of the usual speed, to both sides
constexpr double kStandingSpeed = 0.1;    // metres a second: slower, a trajectory stands
constexpr double kStandingSeconds = 0.4;  // for as long at least
constexpr float kStandingDrift = 0.15f;   // metres: it stands while it stays within
constexpr double kDriftSeconds = 0.5;     // in which a drift is caught up afterwards
constexpr float kRouteStep = 0.05f;       // metres between the points of a trajectory's route
constexpr double kLeastStep = 1e-6;       // metres a frame of somebody who does not stand

// ---- Paths

/// One lane of a path, before anybody walks there.
struct Lane {
  Journey journey;
  double headway = 0.0;  ///< seconds between two people at least
  std::uint32_t room = 0;
  std::uint32_t people = 0;
};

/// Stops of the path's middle, on a lane beside it: at the same part of the way.
std::vector<Journey::Stop> stopsOn(const ScenePath& path, const Route& middle, const Route& lane) {
  std::vector<Journey::Stop> stops;
  for (const ScenePathStop& stop : path.stops) {
    stops.push_back({double{stop.at} / middle.length() * lane.length(), double{stop.seconds}});
  }
  return stops;
}

std::vector<Lane> makeLanes(const ScenePath& path, const ScenePlacement& placement, float least_speed,
                            float most_speed, const RandomStream& speeds, std::uint64_t first_lane) {
  const Route middle = Route::throughWaypoints(path.points, path.closed, path.corner_radius);
  if (!path.stops.empty() && double{path.stops.back().at} >= middle.length()) {
    throw PathProblem{path.mark,
                      fmt::format("a stop at {} m is not on the path, which is {:.2f} m long",
                                  path.stops.back().at, middle.length()),
                      "move the stop or lengthen the path"};
  }
  const int lane_count = 1 + static_cast<int>(path.width / placement.spacing);
  std::vector<Lane> lanes;
  for (int i = 0; i < lane_count; ++i) {
    const float part =
        lane_count > 1 ? static_cast<float>(i) / static_cast<float>(lane_count - 1) - 0.5f : 0.0f;
    const float offset = part * path.width;
    if (!middle.fits(offset)) {
      throw PathProblem{
          path.mark, fmt::format("a corner is too tight for a width of {} m", path.width),
          "raise corner_radius above half the width, move its points apart, or lower the width"};
    }
    Route route = middle.beside(offset);
    const float u = speeds.uniformFloat(first_lane + static_cast<std::uint64_t>(i));
    const double speed = double{glm::mix(least_speed, most_speed, u)};
    const std::vector<Journey::Stop> stops = stopsOn(path, middle, route);
    Journey journey =
        Journey::withStops(std::move(route), speed, double{placement.walking.acceleration}, stops);
    // Who stands is caught up with: the one behind must come a stand and a start later.
    double headway = double{placement.spacing} / speed;
    for (const Journey::Stop& stop : stops) {
      headway = std::max(headway, double{placement.spacing} / speed + stop.seconds +
                                      speed / double{placement.walking.acceleration});
    }
    const auto room = static_cast<std::uint32_t>(journey.seconds() / headway + 1e-4);
    lanes.push_back({std::move(journey), headway, room, 0});
  }
  return lanes;
}

/// Lets the people of a path's lanes set out, evenly and with a little chance.
void fillLanes(std::vector<Lane>& lanes, std::uint32_t people, CrowdWalkers& crowd, std::uint64_t seed) {
  const RandomStream shifts(seed, crowd_stream::kPathShift);
  for (std::uint32_t i = 0; i < people; ++i) ++lanes[i % lanes.size()].people;
  for (Lane& lane : lanes) {
    const double apart = lane.journey.seconds() / std::max(lane.people, 1u);
    const auto journey = static_cast<std::uint32_t>(crowd.journeys.size());
    const double lane_shift = shifts.uniform((std::uint64_t{1} << 40) + journey) * lane.journey.seconds();
    for (std::uint32_t k = 0; k < lane.people; ++k) {
      const double slack = std::max(0.0, apart - lane.headway);
      Walker walker;
      walker.journey = journey;
      walker.head_start = lane_shift + apart * k + (shifts.uniform(crowd.walkers.size()) - 0.5) * slack;
      crowd.walkers.push_back(walker);
    }
    crowd.journeys.push_back(std::move(lane.journey));
  }
}

/// Whole shares of `count` in proportion to weights, the largest remainders rounded up.
std::vector<std::uint32_t> shareOut(std::uint32_t count, const std::vector<double>& weights) {
  double sum = 0.0;
  for (const double weight : weights) sum += weight;
  std::vector<std::uint32_t> shares;
  std::vector<std::pair<double, std::size_t>> remainders;
  std::uint32_t given = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double share = count * weights[i] / sum;
    shares.push_back(static_cast<std::uint32_t>(share));
    given += shares.back();
    if (weights[i] > 0.0) remainders.emplace_back(share - std::floor(share), i);
  }
  std::stable_sort(remainders.begin(), remainders.end(), [](auto a, auto b) { return a.first > b.first; });
  for (std::size_t i = 0; given < count; ++i, ++given) ++shares[remainders[i % remainders.size()].second];
  return shares;
}

// ---- Trajectories

/// The mean over a window that shrinks towards the ends, so that these stay.
std::vector<Vec3> smoothed(const std::vector<Vec3>& positions, std::size_t reach) {
  std::vector<glm::dvec3> sums{glm::dvec3(0.0)};
  for (const Vec3& position : positions) sums.push_back(sums.back() + glm::dvec3(position));
  std::vector<Vec3> result;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const std::size_t side = std::min({reach, i, positions.size() - 1 - i});
    result.emplace_back((sums[i + side + 1] - sums[i - side]) / static_cast<double>(2 * side + 1));
  }
  return result;
}

/// Frames between which somebody stands, made to stand there exactly. Returns per step whether it is one.
std::vector<bool> findStands(std::vector<Vec3>& positions, double fps) {
  std::vector<bool> stands(positions.size() - 1, false);
  const auto least_frames = static_cast<std::size_t>(std::ceil(kStandingSeconds * fps));
  const auto drift_frames = std::max<std::size_t>(1, static_cast<std::size_t>(kDriftSeconds * fps));
  for (std::size_t first = 0; first + 1 < positions.size();) {
    std::size_t last = first;
    while (last + 1 < positions.size() &&
           double{glm::distance(positions[last + 1], positions[last])} * fps < kStandingSpeed &&
           glm::distance(positions[last + 1], positions[first]) < kStandingDrift) {
      ++last;
    }
    if (last - first < least_frames && !(first == 0 && last + 1 == positions.size())) {
      ++first;
      continue;
    }
    const Vec3 drift = positions[first] - positions[last];
    for (std::size_t i = first; i < last; ++i) {
      positions[i + 1] = positions[first];
      stands[i] = true;
    }
    for (std::size_t k = 1; k <= drift_frames && last + k < positions.size(); ++k) {
      const float u = static_cast<float>(k) / static_cast<float>(drift_frames);
      positions[last + k] += drift * (1.0f - u * u * (3.0f - 2.0f * u));
    }
    first = last + 1;
  }
  return stands;
}

/// A route through points a few centimetres apart, and the distance on it of every frame.
Route routeThrough(const std::vector<Vec3>& positions, std::vector<double>& distances) {
  std::vector<double> walked{0.0};
  for (std::size_t i = 1; i < positions.size(); ++i) {
    walked.push_back(walked.back() + double{glm::distance(positions[i], positions[i - 1])});
  }
  std::vector<Vec3> points{positions[0]};
  std::vector<std::size_t> frames{0};
  for (std::size_t i = 1; i < positions.size(); ++i) {
    if (glm::distance(positions[i], points.back()) < kRouteStep) continue;
    points.push_back(positions[i]);
    frames.push_back(i);
  }
  distances.assign(positions.size(), 0.0);
  double at = 0.0;
  for (std::size_t p = 0; p + 1 < points.size(); ++p) {
    const double length = double{glm::distance(points[p], points[p + 1])};
    const double way = walked[frames[p + 1]] - walked[frames[p]];
    for (std::size_t i = frames[p]; i <= frames[p + 1]; ++i) {
      distances[i] = at + (walked[i] - walked[frames[p]]) / way * length;
    }
    at += length;
  }
  for (std::size_t i = frames.back(); i < positions.size(); ++i)
    distances[i] = at + (walked[i] - walked[frames.back()]);
  return Route::alongPoints(points);
}

/// The harmonic mean of the speeds before and after: never overshoots (Fritsch and Carlson 1980).
double speedBetween(double before, double after) {
  return before > 0.0 && after > 0.0 ? 2.0 * before * after / (before + after) : 0.0;
}

Journey journeyAlong(const Trajectory& trajectory, double fps, const ScenePlacement& placement) {
  std::vector<Vec3> positions = smoothed(
      trajectory.positions, static_cast<std::size_t>(0.5 * double{placement.walking.smoothing} * fps));
  for (Vec3& position : positions) position += placement.center;
  if (positions.size() == 1) positions.push_back(positions[0]);
  const std::vector<bool> stands = findStands(positions, fps);
  std::vector<double> distances;
  Route route = routeThrough(positions, distances);
  std::vector<Journey::Knot> knots{{0.0, 0.0, 0.0}};
  for (std::size_t i = 0; i + 1 < positions.size(); ++i) {
    const double step = stands[i] ? 0.0 : std::max(distances[i + 1] - distances[i], kLeastStep);
    knots.push_back({static_cast<double>(i + 1) / fps, knots.back().distance + step, 0.0});
  }
  const auto speedAfter = [&](std::size_t i) { return (knots[i + 1].distance - knots[i].distance) * fps; };
  for (std::size_t i = 1; i + 1 < knots.size(); ++i)
    knots[i].speed = speedBetween(speedAfter(i - 1), speedAfter(i));
  knots.front().speed = speedAfter(0);
  knots.back().speed = speedAfter(knots.size() - 2);
  return Journey(std::move(route), std::move(knots), Journey::Repeat::kNever);
}

}  // namespace

CrowdWalkers placeOnPaths(const ScenePlacement& placement, std::uint32_t count, std::uint64_t seed,
                          float usual_speed) {
  const float least =
      placement.walking.speed ? (*placement.walking.speed)[0] : (1.0f - kSpeedSpread) * usual_speed;
  const float most =
      placement.walking.speed ? (*placement.walking.speed)[1] : (1.0f + kSpeedSpread) * usual_speed;
  const RandomStream speeds(seed, crowd_stream::kLaneSpeed);
  std::vector<std::vector<Lane>> lanes;
  std::vector<double> weights;
  std::uint64_t lane_count = 0;
  for (const ScenePath& path : placement.paths) {
    lanes.push_back(makeLanes(path, placement, least, most, speeds, lane_count));
    lane_count += lanes.back().size();
    weights.push_back(double{path.weight} * static_cast<double>(lanes.back().size()));
  }
  const std::vector<std::uint32_t> shares = shareOut(count, weights);
  CrowdWalkers crowd;
  for (std::size_t p = 0; p < lanes.size(); ++p) {
    std::uint64_t room = 0;
    std::uint32_t least_room = lanes[p][0].room;
    for (const Lane& lane : lanes[p]) least_room = std::min(least_room, lane.room);
    room = std::uint64_t{least_room} * lanes[p].size();
    if (shares[p] > room) {
      throw PathProblem{
          placement.paths[p].mark,
          fmt::format("{} people don't fit on the path, which has room for {} that keep {} m apart",
                      shares[p], room, placement.spacing),
          "lower crowd.count, its weight, the spacing or the seconds of stops; or widen it"};
    }
    fillLanes(lanes[p], shares[p], crowd, seed);
  }
  return crowd;
}

CrowdWalkers followTrajectories(const Trajectories& trajectories, float fps,
                                const ScenePlacement& placement) {
  CrowdWalkers crowd;
  for (const Trajectory& trajectory : trajectories.people) {
    Walker walker;
    walker.journey = static_cast<std::uint32_t>(crowd.journeys.size());
    walker.head_start = -static_cast<double>(trajectory.first_frame) / double{fps};
    crowd.walkers.push_back(walker);
    crowd.journeys.push_back(journeyAlong(trajectory, double{fps}, placement));
  }
  return crowd;
}

WalkStyle makeWalkStyle(const TemplateBody& body, std::uint32_t walk_clip,
                        std::optional<std::uint32_t> idle_clip, float idle_below) {
  const Clip& walk = body.clips[walk_clip];
  ENSEMBLE_CHECK(walk.ground_speed > 0.0f);
  WalkStyle style{.walk_clip = walk_clip,
                  .idle_clip = idle_clip,
                  .stride = walk.ground_speed * walk.seconds,
                  .idle_seconds = idle_clip ? body.clips[*idle_clip].seconds : 0.0f,
                  .idle_below = idle_below,
                  .gait = {},
                  .walk_ankles = {},
                  .idle_ankles = {}};
  const std::optional<Legs> legs = findLegs(body.skeleton);
  if (!legs) return style;
  style.gait = analyzeGait(body.skeleton, *legs, walk);
  style.walk_ankles = anklePaths(body.skeleton, *legs, walk);
  if (idle_clip) style.idle_ankles = anklePaths(body.skeleton, *legs, body.clips[*idle_clip]);
  return style;
}

}  // namespace ensemble
