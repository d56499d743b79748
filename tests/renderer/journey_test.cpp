// Routes and journeys against closed forms.
#include "renderer/journey.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ensemble {
namespace {

Route square(float side, float radius) {
  const float h = 0.5f * side;
  const std::vector<Vec3> corners = {{h, 0, -h}, {h, 0, h}, {-h, 0, h}, {-h, 0, -h}};
  return Route::throughWaypoints(corners, true, radius);
}

void expectNear(Vec3 is, Vec3 should, float error) {
  EXPECT_LT(glm::distance(is, should), error) << is.x << ", " << is.y << ", " << is.z;
}

TEST(Route, RoundsCornersByArcs) {
  const Route route = square(10.0f, 2.0f);
  EXPECT_NEAR(route.length(), 4.0 * (10.0 - 4.0) + 2.0 * M_PI * 2.0, 1e-2);
  EXPECT_TRUE(route.closed());
  // It goes anticlockwise seen from below: +Z first along x = 5, from the middle of the last side.
  const Route::At start = route.at(0.0);
  expectNear(start.position, {0, 0, -5}, 1e-4f);
  EXPECT_NEAR(start.heading, kPi / 2.0f, 1e-5f);
  expectNear(route.at(3.0 + M_PI).position, {5, 0, -3}, 5e-3f);
  EXPECT_NEAR(route.at(3.0 + M_PI + 0.1).heading, 0.0f, 1e-3f);
  const Route::At half_arc = route.at(3.0 + 0.5 * M_PI);
  EXPECT_NEAR(half_arc.heading, kPi / 4.0f, 1e-2f);
  expectNear(half_arc.position, Vec3(3, 0, -3) + 2.0f * Vec3(std::sqrt(0.5f), 0, -std::sqrt(0.5f)), 5e-3f);
  // Round and round: the same places, and headings that go on turning.
  const Route::At later = route.at(3.0 + 0.5 * M_PI + 2.0 * route.length());
  expectNear(later.position, half_arc.position, 1e-3f);
  EXPECT_NEAR(later.heading, half_arc.heading - 4.0f * kPi, 1e-3f);
}

TEST(Route, OpenOnesGoOnStraight) {
  const std::vector<Vec3> points = {{0, 0, 0}, {0, 0, 4}, {3, 1, 4}};
  const Route route = Route::throughWaypoints(points, false, 0.0f);
  EXPECT_NEAR(route.length(), 4.0 + std::sqrt(10.0), 1e-5);
  expectNear(route.at(-1.0).position, {0, 0, -1}, 1e-5f);
  expectNear(route.at(route.length() + 2.0).position, {5, 1, 4}, 1e-4f);
  expectNear(route.at(2.0).position, {0, 0, 2}, 1e-5f);
}

TEST(Route, CornersShrinkWhereThereIsNoRoom) {
  const std::vector<Vec3> points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}};
  const Route route = Route::throughWaypoints(points, false, 5.0f);
  EXPECT_NEAR(route.length(), 1.0 + 0.25 * M_PI, 1e-3) << "an arc of radius 0.5";
}

TEST(Route, LanesKeepTheirDistance) {
  const Route route = square(10.0f, 2.0f);
  EXPECT_TRUE(route.fits(1.5f));
  EXPECT_FALSE(route.fits(-2.5f)) << "to the inner side";
  const Route outer = route.beside(1.5f), inner = route.beside(-1.5f);
  EXPECT_NEAR(outer.length() - route.length(), 2.0 * M_PI * 1.5, 2e-2);
  EXPECT_NEAR(inner.length() - route.length(), -2.0 * M_PI * 1.5, 2e-2);
  for (double part = 0.0; part < 1.0; part += 0.01) {
    const Vec3 p = outer.at(part * outer.length()).position;
    float nearest = 1e9f;
    for (double s = 0.0; s < route.length(); s += 0.02)
      nearest = std::min(nearest, glm::distance(p, route.at(s).position));
    EXPECT_NEAR(nearest, 1.5f, 0.01f);
  }
}

Route straight(float length) {
  const std::vector<Vec3> points = {{0, 0, 0}, {0, 0, length}};
  return Route::throughWaypoints(points, false, 0.0f);
}

TEST(Journey, SlowsDownStandsAndGoesOn) {
  // 2 m/s, 1 m/s^2: two metres and two seconds to stand.
  const std::vector<Journey::Stop> stops = {{10.0, 3.0}};
  const Journey journey = Journey::withStops(straight(20.0f), 2.0, 1.0, stops);
  // 8 m in 4 s, 2 m in 2 s, 3 s, 2 m in 2 s, 8 m in 4 s.
  EXPECT_NEAR(journey.seconds(), 15.0, 1e-9);
  EXPECT_NEAR(journey.at(2.0).distance, 4.0, 1e-9);
  EXPECT_NEAR(journey.at(5.0).distance, 8.0 + 1.5, 1e-9);
  EXPECT_NEAR(journey.at(5.0).speed, 1.0, 1e-9);
  for (const double t : {6.0, 7.5, 9.0}) {
    EXPECT_NEAR(journey.at(t).distance, 10.0, 1e-9) << t;
    EXPECT_NEAR(journey.at(t).speed, 0.0, 1e-6) << t;
  }
  EXPECT_NEAR(journey.at(10.0).distance, 10.5, 1e-9);
  EXPECT_NEAR(journey.at(14.0).distance, 18.0, 1e-9);
  ASSERT_EQ(journey.stretches().size(), 2u);
  EXPECT_FALSE(journey.stretches()[0].begins_standing);
  EXPECT_TRUE(journey.stretches()[0].ends_standing);
  EXPECT_TRUE(journey.stretches()[1].begins_standing);
  EXPECT_FALSE(journey.stretches()[1].ends_standing);
  EXPECT_EQ(journey.at(7.0).stretch, 0u);
  EXPECT_EQ(journey.at(9.5).stretch, 1u);
  EXPECT_EQ(journey.at(16.0).lap, 1);
  EXPECT_NEAR(journey.at(16.0).distance, 2.0, 1e-9);
  EXPECT_NEAR(journey.at(-1.0).distance, 18.0, 1e-9) << "the lap before";
}

TEST(Journey, AShortWayNeverReachesItsSpeed) {
  const std::vector<Journey::Stop> stops = {{4.0, 1.0}, {5.0, 1.0}};
  const Journey journey = Journey::withStops(straight(9.0f), 2.0, 1.0, stops);
  // From 4 to 5: half a metre up to 1 m/s in a second, and down again.
  const double leaves = 3.0 + 1.0;  // 2 m at 2 m/s, 2 m slowing down, a second of standing
  EXPECT_NEAR(journey.at(leaves + 1.0).distance, 4.5, 1e-9);
  EXPECT_NEAR(journey.at(leaves + 1.0).speed, 1.0, 1e-9);
  EXPECT_NEAR(journey.at(leaves + 2.0).distance, 5.0, 1e-9);
}

TEST(Journey, ALoopBeginsAtItsFirstStop) {
  const std::vector<Journey::Stop> stops = {{5.0, 2.0}};
  const Journey journey = Journey::withStops(square(10.0f, 2.0f), 1.0, 1.0, stops);
  ASSERT_EQ(journey.stretches().size(), 1u);
  EXPECT_TRUE(journey.stretches()[0].begins_standing);
  EXPECT_TRUE(journey.stretches()[0].ends_standing);
  const double length = square(10.0f, 2.0f).length();
  EXPECT_NEAR(journey.seconds(), length + 1.0 + 2.0, 1e-6);
  expectNear(journey.placeAt(0.0).position, square(10.0f, 2.0f).at(5.0).position, 1e-4f);
  EXPECT_EQ(journey.at(journey.seconds() * 2.5).lap, 2);
}

}  // namespace
}  // namespace ensemble
