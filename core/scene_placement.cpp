// The scene's `crowd.placement`.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "core/crowd_table.h"
#include "core/scene_keys.h"

namespace ensemble {
namespace {

constexpr NumberRange kSpacingRange{0.01, 1000.0, false, false, "metres"};
constexpr NumberRange kJitterRange{0.0, 0.45, false, false, "share of the spacing"};
constexpr NumberRange kHeadingSpreadRange{0.0, 180.0, false, false, "degrees"};
constexpr NumberRange kWidthRange{0.0, 1000.0, false, false, "metres"};
constexpr NumberRange kLengthRange{0.0, 1e6, false, false, "metres"};
constexpr NumberRange kDurationRange{0.0, 1e5, true, false, "seconds"};
constexpr NumberRange kWalkingSpeedRange{0.0, 20.0, true, false, "metres a second"};
constexpr NumberRange kAccelerationRange{0.0, 100.0, true, false, "metres a second squared"};
constexpr NumberRange kSmoothingRange{0.0, 10.0, false, false, "seconds"};

std::vector<Vec3> readPoints(const YamlValue& value, bool closed) {
  std::vector<Vec3> points;
  for (const YamlValue& item : value.items("a list of points [x, y, z]")) {
    points.push_back(item.vector(kPositionRange));
    if (points.size() > 1 && glm::distance(points[points.size() - 2], points.back()) < 0.01f) {
      item.fail(item.path() + " is where the point before it is", "move it or remove it");
    }
  }
  const std::size_t least = closed ? 3 : 2;
  if (points.size() < least) {
    value.fail(fmt::format("{} has {} points", value.path(), points.size()),
               fmt::format("give {} at least", least));
  }
  if (closed && glm::distance(points.front(), points.back()) < 0.01f) {
    value.fail(value.path() + " ends where it begins, and is closed anyway", "remove the last point");
  }
  return points;
}

std::vector<ScenePathStop> readStops(const YamlValue& value) {
  std::vector<ScenePathStop> stops;
  for (const YamlValue& item : value.items("a list of stops")) {
    item.expectKeys({"at", "seconds"});
    ScenePathStop stop;
    const auto at = item.find("at");
    if (!at) item.fail("the stop has no place", "add 'at: METRES', from the path's start");
    stop.at = at->numberFloat(kLengthRange);
    if (!stops.empty() && stop.at <= stops.back().at) {
      at->fail(at->path() + " is not beyond the stop before it", "list stops in the order of the path");
    }
    if (const auto seconds = item.find("seconds")) stop.seconds = seconds->numberFloat(kDurationRange);
    stops.push_back(stop);
  }
  return stops;
}

ScenePath readPath(const YamlValue& value) {
  value.expectKeys({"points", "closed", "width", "corner_radius", "weight", "stops"});
  ScenePath path;
  path.mark = value.mark();
  if (const auto closed = value.find("closed")) path.closed = closed->boolean();
  const auto points = value.find("points");
  if (!points) value.fail("the path has no points", "add 'points: [[0, 0, 0], [10, 0, 0]]'");
  path.points = readPoints(*points, path.closed);
  if (const auto width = value.find("width")) path.width = width->numberFloat(kWidthRange);
  if (const auto radius = value.find("corner_radius")) path.corner_radius = radius->numberFloat(kWidthRange);
  if (const auto weight = value.find("weight")) path.weight = weight->numberFloat(kWeightRange);
  if (const auto stops = value.find("stops")) path.stops = readStops(*stops);
  return path;
}

void readPaths(const YamlValue& value, ScenePlacement& placement) {
  float weights = 0.0f;
  for (const YamlValue& path : value.items("a list of paths")) {
    placement.paths.push_back(readPath(path));
    weights += placement.paths.back().weight;
  }
  if (placement.paths.empty()) value.fail(value.path() + " is empty", "give at least one path");
  if (weights <= 0.0f) value.fail("every path has the weight 0", "give at least one above 0");
}

void readWalking(const YamlValue& value, SceneWalking& walking) {
  if (const auto speed = value.find("speed")) walking.speed = readSpan(*speed, kWalkingSpeedRange);
  if (const auto acceleration = value.find("acceleration")) {
    walking.acceleration = acceleration->numberFloat(kAccelerationRange);
  }
  if (const auto below = value.find("idle_below"))
    walking.idle_below = below->numberFloat(kWalkingSpeedRange);
  if (const auto idle = value.find("idle")) walking.idle = readName(*idle, "a clip's name");
  if (const auto smoothing = value.find("smoothing"))
    walking.smoothing = smoothing->numberFloat(kSmoothingRange);
  if (const auto fps = value.find("fps")) walking.fps = fps->numberFloat(kFpsRange);
}

struct PlacementKeys {
  const char* name;
  PlacementKind kind;
  std::vector<std::string_view> own;  ///< beside `kind`
};

const PlacementKeys& tableKeys() {
  static const PlacementKeys keys = {
      "file", PlacementKind::kTable, {"file", "center", "heading", "heading_spread"}};
  return keys;
}

const std::vector<PlacementKeys>& placementKinds() {
  static const std::vector<PlacementKeys> kinds = {
      {"grid", PlacementKind::kGrid, {"spacing", "center", "heading", "heading_spread", "jitter", "columns"}},
      {"disc", PlacementKind::kDisc, {"spacing", "center", "heading", "heading_spread"}},
      {"formation",
       PlacementKind::kFormation,
       {"spacing", "center", "heading", "heading_spread", "jitter", "columns"}},
      {"paths", PlacementKind::kPaths, {"paths", "spacing", "speed", "acceleration", "idle_below", "idle"}},
      {"file", PlacementKind::kFile, {"file", "center", "idle_below", "idle", "smoothing", "fps"}}};
  return kinds;
}

/// A key that another kind of placement has is an error that says which.
void refuseOthersKeys(const YamlValue& value, const PlacementKeys& chosen) {
  for (const PlacementKeys& other : placementKinds()) {
    for (const std::string_view key : other.own) {
      if (std::find(chosen.own.begin(), chosen.own.end(), key) != chosen.own.end()) continue;
      const auto found = value.find(key);
      if (!found) continue;
      if (chosen.kind == PlacementKind::kTable) {
        found->fail(fmt::format("{} means nothing for a crowd table", found->path()), "remove it");
      }
      found->fail(fmt::format("{} means nothing for 'kind: {}'", found->path(), chosen.name),
                  fmt::format("remove it, or give 'kind: {}'", other.name));
    }
  }
}

void readHeading(const YamlValue& value, ScenePlacement& placement) {
  if (const auto heading = value.find("heading")) {
    placement.heading = headingRadians(*heading);
    placement.heading_mark = heading->mark();
  }
  if (const auto spread = value.find("heading_spread")) {
    placement.heading_spread = radians(spread->numberFloat(kHeadingSpreadRange));
    if (!placement.heading && placement.kind != PlacementKind::kFormation) {
      spread->fail("heading_spread without heading, where headings are random", "add a heading");
    }
  }
}

}  // namespace

void readPlacement(const YamlValue& value, const std::filesystem::path& base, ScenePlacement& placement) {
  value.expectKeys({"kind", "spacing", "center", "heading", "heading_spread", "jitter", "columns", "paths",
                    "file", "speed", "acceleration", "idle_below", "idle", "smoothing", "fps"});
  const auto kind = value.find("kind");
  const std::size_t index = kind ? kind->word({"grid", "disc", "formation", "paths", "file"}) : 0;
  const auto file = value.find("file");
  if (file) placement.file = {base / file->text("a file"), file->mark()};
  const bool is_table =
      placementKinds()[index].kind == PlacementKind::kFile && isCrowdTable(placement.file.value);
  const PlacementKeys& keys = is_table ? tableKeys() : placementKinds()[index];
  placement.kind = keys.kind;
  refuseOthersKeys(value, keys);
  if (const auto spacing = value.find("spacing")) placement.spacing = spacing->numberFloat(kSpacingRange);
  if (const auto center = value.find("center")) placement.center = center->vector(kPositionRange);
  readHeading(value, placement);
  if (const auto jitter = value.find("jitter")) placement.jitter = jitter->numberFloat(kJitterRange);
  if (const auto columns = value.find("columns")) {
    placement.columns = static_cast<std::uint32_t>(columns->wholeNumber(0, kMaxCrowd));
  }
  if (const auto paths = value.find("paths")) readPaths(*paths, placement);
  readWalking(value, placement.walking);
  if (placement.kind == PlacementKind::kPaths && placement.paths.empty()) {
    value.fail("the placement has no paths", "add 'paths:' with a list of them");
  }
  if (placement.kind == PlacementKind::kFile && placement.file.value.empty()) {
    value.fail("the placement has no file", "add 'file: FILE' with trajectories, or a crowd table (.csv)");
  }
}

}  // namespace ensemble
