#include "renderer/placement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

#include "core/random.h"

namespace ensemble {
namespace {

double distanceOf(const Place& a, const Place& b) {
  const double dx = static_cast<double>(a.position.x) - b.position.x;
  const double dz = static_cast<double>(a.position.z) - b.position.z;
  return std::sqrt(dx * dx + dz * dz);
}

/// The least distance between any two, if it is below `limit`; cells of that size hold the rest off.
double leastDistance(const std::vector<Place>& places, double limit) {
  std::map<std::pair<long, long>, std::vector<const Place*>> cells;
  double least = limit;
  for (const Place& place : places) {
    const long x = std::lround(place.position.x / limit), z = std::lround(place.position.z / limit);
    for (long i = x - 1; i <= x + 1; ++i) {
      for (long j = z - 1; j <= z + 1; ++j) {
        const auto cell = cells.find({i, j});
        if (cell == cells.end()) continue;
        for (const Place* other : cell->second) least = std::min(least, distanceOf(place, *other));
      }
    }
    cells[{x, z}].push_back(&place);
  }
  return least;
}

ScenePlacement placementOf(PlacementKind kind, float spacing) {
  ScenePlacement placement;
  placement.kind = kind;
  placement.spacing = spacing;
  return placement;
}

TEST(Random, IsTheSameOnEveryMachine) {
  // SplitMix64's first output for the state 0, from its authors' reference code.
  EXPECT_EQ(mixBits(0x9e3779b97f4a7c15ull), 0xe220a8397b1dcdafull);
  // Pinned: these numbers are in every crowd that was ever made.
  const RandomStream random(7, 3);
  EXPECT_EQ(random.bits(0), 431888183886164993ull);
  EXPECT_EQ(random.bits(1'000'000), 9026602947867915180ull);
  EXPECT_NE(random.bits(0), RandomStream(7, 4).bits(0));
  EXPECT_NE(random.bits(0), RandomStream(8, 3).bits(0));
}

TEST(Random, IsUniform) {
  const RandomStream random(1, 2);
  constexpr int kDraws = 100'000, kBins = 16;
  std::array<int, kBins> bins{};
  double sum = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double u = random.uniform(static_cast<std::uint64_t>(i));
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    ASSERT_LT(random.uniformFloat(static_cast<std::uint64_t>(i)), 1.0f);
    sum += u;
    ++bins[static_cast<std::size_t>(u * kBins)];
  }
  EXPECT_NEAR(sum / kDraws, 0.5, 0.005);
  // Binomial: standard deviation 77, five of them.
  for (const int bin : bins) EXPECT_NEAR(bin, kDraws / kBins, 385);
}

TEST(Grid, IsSquareAndCentred) {
  const auto places = placePeople(placementOf(PlacementKind::kGrid, 2.0f), 9, 1);
  ASSERT_EQ(places.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i) {
    const Vec3 expected(2.0f * static_cast<float>(i % 3) - 2.0f, 0, 2.0f * static_cast<float>(i / 3) - 2.0f);
    EXPECT_EQ(places[i].position, expected);
  }
}

TEST(Grid, TakesColumnsACentreAndAHeading) {
  ScenePlacement placement = placementOf(PlacementKind::kGrid, 1.0f);
  placement.columns = 4;
  placement.center = {10, 2, -5};
  placement.heading = 1.5f;
  const auto places = placePeople(placement, 6, 1);
  EXPECT_EQ(places[0].position, Vec3(8.5f, 2, -5.5f));
  EXPECT_EQ(places[3].position, Vec3(11.5f, 2, -5.5f));
  EXPECT_EQ(places[5].position, Vec3(9.5f, 2, -4.5f));
  for (const Place& place : places) EXPECT_EQ(place.heading, 1.5f);
  placement.columns = 1000;
  EXPECT_EQ(placePeople(placement, 6, 1)[5].position, Vec3(12.5f, 2, -5));
}

TEST(Grid, HeadingsAreRandomAllAround) {
  const auto places = placePeople(placementOf(PlacementKind::kGrid, 1.0f), 10'000, 1);
  int quarters[4] = {};
  for (const Place& place : places) {
    ASSERT_GE(place.heading, 0.0f);
    ASSERT_LE(place.heading, 2.0f * kPi);
    ++quarters[std::min(3, static_cast<int>(place.heading / (kPi / 2)))];
  }
  for (const int quarter : quarters) EXPECT_NEAR(quarter, 2500, 217);  // five standard deviations
}

TEST(Placement, JitterKeepsPeopleApart) {
  for (const PlacementKind kind : {PlacementKind::kGrid, PlacementKind::kFormation}) {
    ScenePlacement placement = placementOf(kind, 1.0f);
    placement.jitter = 0.45f;
    const auto places = placePeople(placement, 2000, 3);
    const double least = leastDistance(places, 1.0);
    EXPECT_GE(least, 0.1 - 1e-5);
    EXPECT_LT(least, 0.4);  // it does move people
  }
}

TEST(Placement, HeadingSpreadStaysWithinItsBounds) {
  ScenePlacement placement = placementOf(PlacementKind::kFormation, 1.0f);
  placement.heading = 1.0f;
  placement.heading_spread = 0.5f;
  float least = 10.0f, most = -10.0f;
  for (const Place& place : placePeople(placement, 1000, 1)) {
    least = std::min(least, place.heading);
    most = std::max(most, place.heading);
  }
  EXPECT_GE(least, 0.5f);
  EXPECT_LE(most, 1.5f);
  EXPECT_LT(least, 0.52f);
  EXPECT_GT(most, 1.48f);
}

TEST(Formation, FacesItsHeadingWithTheFirstRankInFront) {
  ScenePlacement placement = placementOf(PlacementKind::kFormation, 1.0f);
  placement.columns = 3;
  const auto ahead = placePeople(placement, 5, 1);  // two ranks, the second of two people
  EXPECT_EQ(ahead[0].position, Vec3(-1, 0, 0.5f));
  EXPECT_EQ(ahead[2].position, Vec3(1, 0, 0.5f));
  EXPECT_EQ(ahead[3].position, Vec3(-0.5f, 0, -0.5f));
  EXPECT_EQ(ahead[4].position, Vec3(0.5f, 0, -0.5f));
  for (const Place& place : ahead) EXPECT_EQ(place.heading, 0.0f);

  placement.heading = radians(90.0f);  // along +X
  const auto right = placePeople(placement, 5, 1);
  EXPECT_NEAR(right[1].position.x, 0.5, 1e-6);
  EXPECT_NEAR(right[1].position.z, 0.0, 1e-6);
  EXPECT_NEAR(right[0].position.z, 1.0, 1e-6);
  EXPECT_NEAR(right[3].position.x, -0.5, 1e-6);
}

TEST(Disc, HoldsExactlyTheCountAtTheLeastDistance) {
  for (const std::uint32_t count : {1u, 2u, 3u, 7u, 10u, 100u, 1000u, 20'000u}) {
    for (const std::uint64_t seed : {1ull, 2ull, 99ull}) {
      const auto places = placePeople(placementOf(PlacementKind::kDisc, 1.2f), count, seed);
      ASSERT_EQ(places.size(), count);
      const double spacing = 1.2f;
      EXPECT_GE(leastDistance(places, spacing), spacing) << count << " people, seed " << seed;
    }
  }
}

TEST(Disc, IsDenseRoundAndCentred) {
  ScenePlacement placement = placementOf(PlacementKind::kDisc, 0.8f);
  placement.center = {100, 3, -50};
  const std::uint32_t count = 5000;
  const auto places = placePeople(placement, count, 5);
  double radius = 0.0, mean_x = 0.0, mean_z = 0.0, before = 0.0;
  int quarters[4] = {};
  for (const Place& place : places) {
    const double x = place.position.x - 100.0, z = place.position.z + 50.0;
    EXPECT_EQ(place.position.y, 3.0f);
    mean_x += x / count;
    mean_z += z / count;
    radius = std::hypot(x, z);
    EXPECT_GE(radius, before);  // from the centre outwards
    before = radius;
    ++quarters[(x > 0 ? 1 : 0) + (z > 0 ? 2 : 0)];
  }
  const double filled = count * 0.8 * 0.8 / (3.14159265 * radius * radius);
  EXPECT_GT(filled, 0.64);  // maximal Poisson-disc samples reach 0.65 to 0.72
  EXPECT_LT(filled, 0.80);
  EXPECT_NEAR(mean_x, 0.0, 0.5);
  EXPECT_NEAR(mean_z, 0.0, 0.5);
  for (const int quarter : quarters) EXPECT_NEAR(quarter, count / 4, count / 40);
  // Maximal: nobody within the crowd has room for another person beside him at 2 spacings.
  int lonely = 0;
  for (std::size_t i = 0; i < 500; ++i) {
    int neighbours = 0;
    for (const Place& other : places) neighbours += distanceOf(places[i], other) < 1.6 ? 1 : 0;
    lonely += neighbours < 4 ? 1 : 0;  // himself and three
  }
  EXPECT_EQ(lonely, 0);
}

TEST(Disc, HasNoGridInIt) {
  // Blue noise looks alike in every direction: directions to near neighbours fill all octants.
  const auto places = placePeople(placementOf(PlacementKind::kDisc, 1.0f), 3000, 1);
  std::array<int, 8> octants{};
  int total = 0;
  for (std::size_t i = 0; i < 1000; ++i) {
    for (std::size_t j = 0; j < places.size(); ++j) {
      if (i == j || distanceOf(places[i], places[j]) > 1.5) continue;
      const double angle = std::atan2(places[j].position.z - places[i].position.z,
                                      places[j].position.x - places[i].position.x);
      ++octants[static_cast<std::size_t>(std::clamp((angle + 3.14159265) / 0.78539816, 0.0, 7.0))];
      ++total;
    }
  }
  for (const int octant : octants) EXPECT_NEAR(octant, total / 8, total / 40);
}

TEST(Disc, SaysWhenPositionsAreTooCoarse) {
  ScenePlacement placement = placementOf(PlacementKind::kDisc, 0.01f);
  placement.center = {1e6f, 0, 0};
  EXPECT_THROW(placePeople(placement, 100, 1), std::length_error);
}

TEST(Placement, IsAFunctionOfTheSeed) {
  for (const PlacementKind kind : {PlacementKind::kGrid, PlacementKind::kDisc, PlacementKind::kFormation}) {
    ScenePlacement placement = placementOf(kind, 1.0f);
    placement.jitter = kind == PlacementKind::kDisc ? 0.0f : 0.2f;
    const auto first = placePeople(placement, 200, 1), again = placePeople(placement, 200, 1),
               other = placePeople(placement, 200, 2);
    int moved = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
      EXPECT_EQ(first[i].position, again[i].position);
      EXPECT_EQ(first[i].heading, again[i].heading);
      moved += first[i].position != other[i].position ? 1 : 0;
    }
    EXPECT_GT(moved, 190);
    EXPECT_TRUE(placePeople(placement, 0, 1).empty());
  }
}

}  // namespace
}  // namespace ensemble
