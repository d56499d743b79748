// People on the move: feet that stay where they stand, room between people, trajectories kept.
#include "renderer/walker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/crowd_walkers.h"
#include "renderer/posed_joints.h"
#include "tests/support/stick_walker.h"

namespace ensemble {
namespace {

using namespace testing;
using ::testing::HasSubstr;

ScenePath pathOf(std::vector<Vec3> points, bool closed) {
  ScenePath path;
  path.points = std::move(points);
  path.closed = closed;
  return path;
}

/// One stick figure on a path.
struct Walk {
  explicit Walk(const ScenePath& path, float scale = 1.0f) {
    ScenePlacement placement;
    placement.kind = PlacementKind::kPaths;
    placement.paths = {path};
    placement.walking.speed = {1.4f, 1.4f};
    CrowdWalkers walkers = placeOnPaths(placement, 1, 3, 1.4f);
    crowd.journeys = std::move(walkers.journeys);
    crowd.walkers = std::move(walkers.walkers);
    crowd.walk_styles = {makeWalkStyle(wardrobe.body, 0, 1, 0.4f)};
    person.walker = 0;
    person.scale = scale;
  }
  CharacterPose at(double seconds) const { return poseAt(crowd, person, 1.0f, seconds); }
  std::vector<Vec3> joints(double seconds) const { return posedJoints(wardrobe.body, at(seconds)); }

  Wardrobe wardrobe = stickWardrobe();
  Crowd crowd;
  Character person;
};

/// The farthest that a foot moves while it is on the ground (its ankle within a millimetre of its
/// lowest), over all its stands; metres.
float worstSlide(const Walk& walk, double seconds, bool hold_feet) {
  float worst = 0.0f;
  for (const std::uint32_t ankle : {kAnkleL, kAnkleR}) {
    std::vector<Vec3> stand;
    for (int frame = 0; frame < static_cast<int>(120 * seconds); ++frame) {
      CharacterPose pose = walk.at(frame / 120.0);
      pose.holds_feet = pose.holds_feet && hold_feet;
      const Vec3 place = posedJoints(walk.wardrobe.body, pose)[ankle];
      if (place.y < (0.08f + 0.001f) * walk.person.scale) {
        stand.push_back(place);
      } else {
        stand.clear();
      }
      for (const Vec3& other : stand) worst = std::max(worst, glm::distance(other, place));
    }
  }
  return worst;
}

TEST(Walker, PhaseIsDistanceOverStride) {
  const Walk walk(pathOf({{0, 0, 0}, {0, 0, 100}}, false));
  const CharacterPose first = walk.at(1.0);
  for (const double t : {1.5, 2.0, 7.25}) {
    const CharacterPose later = walk.at(t);
    const double turns = double{later.position.z - first.position.z} / (2.0 * double{kStickStep});
    const double phase = double{first.phase} + turns;
    EXPECT_NEAR(later.phase, phase - std::floor(phase), 1e-3) << t;
    EXPECT_NEAR(glm::distance(later.position, first.position), 1.4f * (static_cast<float>(t) - 1.0f), 1e-3f);
    EXPECT_EQ(later.idle_weight, 0.0f);
  }
}

TEST(Walker, FeetStayOverTurnsAndStops) {
  ScenePath path = pathOf({{-3, 0, -3}, {3, 0, -3}, {3, 0, 3}, {-2, 0, 2}}, true);
  path.corner_radius = 1.0f;
  path.stops = {{4.0f, 1.5f}, {4.6f, 1.0f}, {13.0f, 2.0f}};
  for (const float scale : {1.0f, 0.9f, 1.1f}) {
    const Walk walk(path, scale);
    EXPECT_LT(worstSlide(walk, 40.0, true), 0.005f) << "scale " << scale;
    EXPECT_GT(worstSlide(walk, 40.0, false), 0.05f) << "without being held they slide: the test sees it";
  }
}

TEST(Walker, StandsInTheIdleClipWithBothFeetDown) {
  ScenePath path = pathOf({{0, 0, 0}, {0, 0, 30}}, false);
  path.stops = {{11.0f, 3.0f}};
  const Walk walk(path);
  int standing = 0;
  const double once = walk.crowd.journeys[0].seconds();
  for (int frame = 0; frame < static_cast<int>(60 * once); ++frame) {
    const CharacterPose pose = walk.at(frame / 60.0);
    if (pose.idle_weight < 1.0f) continue;
    ++standing;
    const std::vector<Vec3> joints = posedJoints(walk.wardrobe.body, pose);
    EXPECT_NEAR(pose.position.z, 11.0f, 1e-3f);
    EXPECT_NEAR(joints[kAnkleL].y, 0.08f, 2e-3f);
    EXPECT_NEAR(joints[kAnkleR].y, 0.08f, 2e-3f);
  }
  EXPECT_NEAR(standing, 180, 3) << "three seconds";
}

TEST(Walker, MovesWithoutJumps) {
  ScenePath path = pathOf({{-3, 0, -3}, {3, 0, -3}, {3, 0, 3}}, true);
  path.stops = {{4.0f, 1.0f}};
  const Walk walk(path);
  std::vector<Vec3> before = walk.joints(0.0);
  for (int frame = 1; frame < 240 * 20; ++frame) {
    const std::vector<Vec3> now = walk.joints(frame / 240.0);
    for (std::size_t j = 0; j < now.size(); ++j) {
      ASSERT_LT(glm::distance(now[j], before[j]), 0.035f) << "joint " << j << " at " << frame / 240.0;
    }
    before = now;
  }
}

TEST(PlaceOnPaths, NobodyComesTooNear) {
  ScenePlacement placement;
  placement.kind = PlacementKind::kPaths;
  placement.spacing = 0.9f;
  placement.paths = {pathOf({{-8, 0, -8}, {8, 0, -8}, {8, 0, 8}, {-8, 0, 8}}, true)};
  placement.paths[0].width = 1.8f;
  placement.paths[0].corner_radius = 2.5f;
  placement.paths[0].stops = {{20.0f, 2.0f}};
  const CrowdWalkers crowd = placeOnPaths(placement, 24, 7, 1.3f);
  ASSERT_EQ(crowd.walkers.size(), 24u);
  EXPECT_EQ(crowd.journeys.size(), 3u);
  for (double t = 0.0; t < 60.0; t += 0.1) {
    std::vector<Vec3> places;
    for (const Walker& walker : crowd.walkers) {
      const Journey& journey = crowd.journeys[walker.journey];
      places.push_back(journey.placeAt(journey.at(t + walker.head_start).distance).position);
    }
    for (std::size_t a = 0; a < places.size(); ++a) {
      for (std::size_t b = a + 1; b < places.size(); ++b) {
        ASSERT_GT(glm::distance(places[a], places[b]), 0.88f) << t << ": " << a << " and " << b;
      }
    }
  }
}

std::string problemOf(const ScenePlacement& placement, std::uint32_t count) {
  try {
    placeOnPaths(placement, count, 1, 1.3f);
  } catch (const PathProblem& problem) {
    return problem.what + "; " + problem.mend;
  }
  return "";
}

TEST(PlaceOnPaths, SaysWhatDoesNotFit) {
  ScenePlacement placement;
  placement.paths = {pathOf({{0, 0, 0}, {0, 0, 12}}, false)};
  EXPECT_EQ(problemOf(placement, 10), "");
  EXPECT_EQ(
      problemOf(placement, 11),
      "11 people don't fit on the path, which has room for 10 that keep 1.2 m apart; lower crowd.count, its "
      "weight, the spacing or the seconds of stops; or widen it");
  placement.paths[0].stops = {{12.0f, 1.0f}};
  EXPECT_EQ(problemOf(placement, 1),
            "a stop at 12 m is not on the path, which is 12.00 m long; move the stop or lengthen the path");
  placement.paths = {pathOf({{0, 0, 0}, {0, 0, 5}, {5, 0, 5}}, false)};
  placement.paths[0].width = 4.0f;
  EXPECT_THAT(problemOf(placement, 1),
              HasSubstr("a corner is too tight for a width of 4 m; raise corner_radius"));
}

Trajectories oneWay(std::vector<Vec3> positions) { return {10.0f, {{7, 5, std::move(positions)}}, {}}; }

TEST(FollowTrajectories, KeepsPlacesAndTimes) {
  std::vector<Vec3> positions;
  for (int i = 0; i <= 80; ++i) {
    const float angle = static_cast<float>(i) * 0.02f;
    positions.push_back(5.0f * Vec3(1.0f - std::cos(angle), 0.0f, std::sin(angle)));
  }
  ScenePlacement placement;
  placement.walking.smoothing = 0.0f;
  const CrowdWalkers crowd = followTrajectories(oneWay(positions), 10.0f, placement);
  ASSERT_EQ(crowd.walkers.size(), 1u);
  const Journey& journey = crowd.journeys[0];
  for (int i = 0; i <= 80; ++i) {
    const Journey::Moment moment = journey.at(crowd.walkers[0].head_start + 0.5 + i / 10.0);
    EXPECT_TRUE(moment.exists);
    const Route::At at = journey.placeAt(moment.distance);
    EXPECT_LT(glm::distance(at.position, positions[static_cast<std::size_t>(i)]), 0.01f) << i;
    EXPECT_NEAR(at.heading, static_cast<float>(i) * 0.02f, 0.02f) << i;
    if (i > 0 && i < 80) {
      EXPECT_NEAR(moment.speed, 1.0, 0.03) << i;
    }
  }
  EXPECT_FALSE(journey.at(crowd.walkers[0].head_start + 0.4).exists);
  EXPECT_FALSE(journey.at(crowd.walkers[0].head_start + 8.6).exists);
}

TEST(FollowTrajectories, StandsStillWhereTheHeadOnlySways) {
  std::vector<Vec3> positions;
  for (int i = 0; i < 20; ++i) positions.emplace_back(0.0f, 0.0f, 0.12f * static_cast<float>(i));
  for (int i = 0; i < 30; ++i)
    positions.push_back(positions[19] + Vec3(0.002f * static_cast<float>(i % 3), 0, 0));
  for (int i = 1; i < 20; ++i) positions.push_back(positions[19] + Vec3(0.12f * static_cast<float>(i), 0, 0));
  const CrowdWalkers crowd = followTrajectories(oneWay(positions), 10.0f, ScenePlacement());
  const Journey& journey = crowd.journeys[0];
  ASSERT_EQ(journey.stretches().size(), 2u);
  const double begin = journey.at(2.6).distance;
  for (double t = 2.6; t < 4.5; t += 0.1) {
    EXPECT_EQ(journey.at(t).distance, begin) << t;
    EXPECT_EQ(journey.at(t).speed, 0.0);
  }
  EXPECT_LT(glm::distance(journey.placeAt(journey.endOf(journey.stretches()[1])).position, positions.back()),
            0.06f);
}

TEST(FollowTrajectories, OneSampleStands) {
  const CrowdWalkers crowd = followTrajectories(oneWay({{1, 0, 2}}), 10.0f, ScenePlacement());
  const Journey::Moment moment = crowd.journeys[0].at(crowd.walkers[0].head_start + 0.5);
  EXPECT_TRUE(moment.exists);
  EXPECT_EQ(moment.speed, 0.0);
  EXPECT_LT(glm::distance(crowd.journeys[0].placeAt(moment.distance).position, Vec3(1, 0, 2)), 1e-4f);
}

}  // namespace
}  // namespace ensemble
