// The keys of people who walk and cameras that move.
#include <gtest/gtest.h>

#include <array>

#include "tests/core/scene_fixture.h"

namespace ensemble {
namespace {

using testing::errorAfterHead;
using testing::kHead;

TEST(SceneErrors, PlacementsRefuseEachOthersKeys) {
  const auto placement = [](const std::string& keys) {
    return errorAfterHead("crowd: {count: 1, placement: {" + keys + "}}\n");
  };
  EXPECT_EQ(placement("kind: paths"), "3:30: the placement has no paths; add 'paths:' with a list of them");
  EXPECT_EQ(placement("kind: file"),
            "3:30: the placement has no file; add 'file: FILE' with trajectories, or a crowd "
            "table (.csv)");
  EXPECT_EQ(placement("file: a.txt"),
            "3:37: crowd.placement.file means nothing for 'kind: grid'; remove it, or give 'kind: file'");
  EXPECT_EQ(placement("kind: paths, columns: 3"),
            "3:53: crowd.placement.columns means nothing for 'kind: paths'; remove it, or give 'kind: grid'");
  EXPECT_EQ(placement("kind: file, file: a.txt, speed: 1"),
            "3:63: crowd.placement.speed means nothing for 'kind: file'; remove it, or give 'kind: paths'");
  EXPECT_EQ(placement("kind: file, file: a.txt, heading: 1"),
            "3:65: crowd.placement.heading means nothing for 'kind: file'; remove it, or give 'kind: grid'");
}

TEST(SceneErrors, ACrowdTableTakesFewKeys) {
  for (const std::string key : {"spacing: 1", "jitter: 0", "columns: 2", "speed: 1", "acceleration: 1",
                                "idle_below: 1", "idle: a", "smoothing: 1", "fps: 9"}) {
    const std::string name = key.substr(0, key.find(':'));
    EXPECT_EQ(errorAfterHead("crowd: {placement: {kind: file, file: a.csv, " + key + "}}\n"),
              "3:" + std::to_string(46 + name.size() + 2) + ": crowd.placement." + name +
                  " means nothing for a crowd table; remove it");
  }
  EXPECT_EQ(errorAfterHead("crowd: {placement: {kind: file, file: a.csv, heading_spread: 9}}\n"),
            "3:62: heading_spread without heading, where headings are random; add a heading");
}

TEST(Scene, AFileNamedCsvIsACrowdTable) {
  const Scene scene = parseScene(
      kHead +
          "crowd: {placement: {kind: file, file: t/a.CSV, center: [1, 2, 3], heading: 90, heading_spread: "
          "5}, scale: 2}\n",
      "a/scene.yaml");
  const ScenePlacement& placement = scene.crowd.placement;
  EXPECT_EQ(placement.kind, PlacementKind::kTable);
  EXPECT_EQ(placement.file.value, "a/t/a.CSV");
  EXPECT_FALSE(scene.crowd.count);
  EXPECT_EQ(placement.center, Vec3(1, 2, 3));
  EXPECT_EQ(placement.heading, radians(90.0f));
  EXPECT_EQ(placement.heading_mark.key_path, "crowd.placement.heading");
  EXPECT_EQ(scene.crowd.scale_mark.key_path, "crowd.scale");
  EXPECT_EQ(parseScene(kHead + "crowd: {count: 1}\n", "a.yaml").crowd.scale_mark.key_path, "");
}

TEST(SceneErrors, PathsAreCheckedPointByPoint) {
  const auto path = [](const std::string& keys) {
    return errorAfterHead("crowd:\n  count: 1\n  placement:\n    kind: paths\n    paths: [{" + keys + "}]\n");
  };
  EXPECT_EQ(path("width: 1"), "7:13: the path has no points; add 'points: [[0, 0, 0], [10, 0, 0]]'");
  EXPECT_EQ(path("points: [[0, 0, 0]]"),
            "7:22: crowd.placement.paths.0.points has 1 points; give 2 at least");
  EXPECT_EQ(path("points: [[0, 0, 0], [1, 0, 0]], closed: true"),
            "7:22: crowd.placement.paths.0.points has 2 points; give 3 at least");
  EXPECT_EQ(path("points: [[0, 0, 0], [0, 0, 0]]"),
            "7:34: crowd.placement.paths.0.points.1 is where the point before it is; move it or remove it");
  EXPECT_EQ(
      path("points: [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 0]], closed: true"),
      "7:22: crowd.placement.paths.0.points ends where it begins, and is closed anyway; remove the last "
      "point");
  EXPECT_EQ(
      path("points: [[0, 0, 0], [9, 0, 0]], stops: [{at: 3}, {at: 2}]"),
      "7:68: crowd.placement.paths.0.stops.1.at is not beyond the stop before it; list stops in the order "
      "of the path");
  EXPECT_EQ(path("points: [[0, 0, 0], [9, 0, 0]], stops: [{seconds: 2}]"),
            "7:54: the stop has no place; add 'at: METRES', from the path's start");
  EXPECT_EQ(path("points: [[0, 0, 0], [9, 0, 0]], weight: 0"),
            "7:12: every path has the weight 0; give at least one "
            "above 0");
}

TEST(SceneErrors, CameraKeysAscend) {
  EXPECT_EQ(errorAfterHead("camera: {keys: []}\n"), "3:16: camera.keys is empty; give a key, or remove it");
  EXPECT_EQ(errorAfterHead("camera: {keys: [{position: [1, 2, 3]}]}\n"),
            "3:17: the camera key has no time; add 'time: SECONDS'");
  EXPECT_EQ(errorAfterHead("camera: {keys: [{time: 1}, {time: 1}]}\n"),
            "3:35: camera.keys.1.time is not after the key before it; give a later time");
  EXPECT_EQ(errorAfterHead("camera: {interpolation: linear}\n"),
            "3:25: camera.interpolation without keys; add keys, or remove it");
  EXPECT_EQ(errorAfterHead("camera: {keys: [{time: 0}], orbit: {}}\n"),
            "3:36: the camera has keys and an orbit; remove one of them");
  EXPECT_EQ(errorAfterHead("camera: {orbit: {seconds: 0}}\n"),
            "3:27: camera.orbit.seconds is 0; give the seconds of a turn");
}

TEST(Scene, ReadsPathsAndWalking) {
  const Scene scene = parseScene(kHead + R"(crowd:
  count: 5
  placement:
    kind: paths
    spacing: 0.8
    speed: [1, 1.5]
    acceleration: 2
    idle_below: 0.3
    idle: wait
    paths:
      - {points: [[0, 0, 0], [0, 0, 9]], width: 2, stops: [{at: 3, seconds: 4}, {at: 5}]}
      - {points: [[0, 0, 0], [0, 0, 9], [9, 0, 9]], closed: true, corner_radius: 3, weight: 2}
)",
                                 "scene.yaml");
  const ScenePlacement& placement = scene.crowd.placement;
  EXPECT_EQ(placement.kind, PlacementKind::kPaths);
  ASSERT_EQ(placement.paths.size(), 2u);
  EXPECT_EQ(placement.paths[0].points[1], Vec3(0, 0, 9));
  EXPECT_EQ(placement.paths[0].stops[0].seconds, 4.0f);
  EXPECT_EQ(placement.paths[0].stops[1].at, 5.0f);
  EXPECT_TRUE(placement.paths[1].closed);
  EXPECT_EQ(placement.paths[1].corner_radius, 3.0f);
  EXPECT_EQ(placement.walking.speed, (std::array{1.0f, 1.5f}));
  EXPECT_EQ(placement.walking.idle.value, "wait");
  EXPECT_EQ(placement.walking.idle_below, 0.3f);
}

TEST(Scene, AFileNeedsNoCount) {
  const Scene scene = parseScene(
      kHead + "crowd: {placement: {kind: file, file: ways.txt, smoothing: 1, fps: 25}}\n", "a/scene.yaml");
  EXPECT_FALSE(scene.crowd.count);
  EXPECT_EQ(scene.crowd.placement.file.value, "a/ways.txt");
  EXPECT_EQ(scene.crowd.placement.walking.fps, 25.0f);
}

TEST(SceneCamera, GoesThroughItsKeys) {
  const Scene scene = parseScene(kHead + R"(camera:
  target: [0, 1, 0]
  keys:
    - {time: 1, position: [0, 2, 10], fov_y: 40}
    - {time: 3, position: [10, 2, 0]}
    - {time: 4, position: [10, 2, -10], target: [0, 0, 0], fov_y: 60}
)",
                                 "scene.yaml");
  const SceneCamera& camera = scene.camera;
  EXPECT_EQ(camera.at(0.0).position, Vec3(0, 2, 10)) << "before the first";
  EXPECT_EQ(camera.at(3.0).position, Vec3(10, 2, 0));
  EXPECT_EQ(camera.at(3.0).target, Vec3(0, 1, 0)) << "as the key before";
  EXPECT_NEAR(camera.at(3.0).fov_y, radians(40.0f), 1e-6f);
  EXPECT_EQ(camera.at(9.0).position, Vec3(10, 2, -10));
  // No corner at a key: the same speed before and after.
  const float h = 1e-3f;
  const Vec3 before = (camera.at(3.0).position - camera.at(3.0 - double{h}).position) / h;
  const Vec3 after = (camera.at(3.0 + double{h}).position - camera.at(3.0).position) / h;
  EXPECT_LT(glm::distance(before, after), 0.1f);
  SceneCamera straight = camera;
  straight.smooth = false;
  EXPECT_LT(glm::distance(straight.at(2.0).position, Vec3(5, 2, 5)), 1e-5f);
  EXPECT_NEAR(straight.at(3.5).fov_y, radians(50.0f), 1e-6f);
}

TEST(SceneCamera, GoesRoundItsTarget) {
  const Scene scene = parseScene(
      kHead + "camera: {position: [1, 3, 4], target: [1, 1, 0], orbit: {seconds: 8}}\n", "scene.yaml");
  EXPECT_LT(glm::distance(scene.camera.at(0.0).position, Vec3(1, 3, 4)), 1e-5f);
  EXPECT_LT(glm::distance(scene.camera.at(2.0).position, Vec3(5, 3, 0)), 1e-4f)
      << "anticlockwise, seen from above";
  EXPECT_LT(glm::distance(scene.camera.at(12.0).position, Vec3(1, 3, -4)), 1e-4f);
  EXPECT_EQ(scene.camera.at(5.0).target, Vec3(1, 1, 0));
}

}  // namespace
}  // namespace ensemble
