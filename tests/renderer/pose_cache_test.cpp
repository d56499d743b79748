#include "renderer/pose_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace ensemble {
namespace {

TEST(PoseCache, KeepsWhatWasAskedFor) {
  PoseCache cache({.budget_vertices = 1000, .buffer_vertices = 1000});
  cache.beginFrame();
  const KeptPose first = cache.require(7, 300), second = cache.require(8, 400);
  EXPECT_TRUE(first.is_new);
  EXPECT_TRUE(second.is_new);
  EXPECT_FALSE(cache.require(7, 300).is_new) << "twice in a frame";
  EXPECT_EQ(cache.stats().misses, 2u);
  EXPECT_EQ(cache.stats().hits, 0u);
  cache.beginFrame();
  const KeptPose again = cache.require(7, 300);
  EXPECT_FALSE(again.is_new);
  EXPECT_EQ(again.first_vertex, first.first_vertex);
  EXPECT_EQ(cache.stats().hits, 1u);
  EXPECT_EQ(cache.stats().misses, 0u);
  EXPECT_EQ(cache.stats().kept_vertices, 700u);
}

TEST(PoseCache, ForgetsAll) {
  PoseCache cache({.budget_vertices = 1000, .buffer_vertices = 500});
  cache.beginFrame();
  for (const std::uint32_t pose : {1u, 2u, 3u}) cache.require(pose, 300);
  cache.clear();
  EXPECT_EQ(cache.stats().kept_vertices, 0u);
  EXPECT_TRUE(cache.require(2, 300).is_new);
  EXPECT_TRUE(cache.require(4, 500).is_new);
  EXPECT_EQ(cache.bufferCount(), 3u) << "there was room";
}

TEST(PoseCache, WhatWasNotUsedForLongestGoesFirst) {
  PoseCache cache({.budget_vertices = 1000, .buffer_vertices = 1000});
  for (const std::uint32_t pose : {1u, 2u, 3u}) {
    cache.beginFrame();
    cache.require(pose, 300);
  }
  cache.beginFrame();
  cache.require(1, 300);
  cache.require(4, 300);
  cache.beginFrame();
  EXPECT_FALSE(cache.require(1, 300).is_new);
  EXPECT_FALSE(cache.require(3, 300).is_new);
  EXPECT_TRUE(cache.require(2, 300).is_new) << "it had been used before 3";
}

TEST(PoseCache, AFrameHasAllThatItAsksForWhateverTheBudget) {
  PoseCache cache({.budget_vertices = 0, .buffer_vertices = 500});
  for (int frame = 0; frame < 3; ++frame) {
    cache.beginFrame();
    EXPECT_EQ(cache.stats().kept_vertices, 0u);
    for (std::uint32_t pose = 0; pose < 4; ++pose) EXPECT_TRUE(cache.require(pose, 200).is_new);
    for (std::uint32_t pose = 0; pose < 4; ++pose) EXPECT_FALSE(cache.require(pose, 200).is_new);
    EXPECT_EQ(cache.bufferCount(), 2u) << "two poses in each, and no more from frame to frame";
  }
}

// Whatever comes and goes: nothing overlaps, and room that is given back is found again.
TEST(PoseCache, PosesNeverOverlap) {
  constexpr std::uint32_t kBuffer = 4000;
  PoseCache cache({.budget_vertices = 9000, .buffer_vertices = kBuffer});
  std::mt19937 random(3);
  const auto size_of = [](std::uint32_t pose) { return 50 + pose * 37 % 700; };
  for (int frame = 0; frame < 300; ++frame) {
    cache.beginFrame();
    EXPECT_LE(cache.stats().kept_vertices, 9000u);
    struct Range {
      std::uint32_t buffer, first, end;
    };
    std::vector<Range> ranges;
    for (int i = 0; i < 12; ++i) {
      const auto pose = static_cast<std::uint32_t>(random() % 60);
      const KeptPose kept = cache.require(pose, size_of(pose));
      ranges.push_back({kept.buffer, kept.first_vertex, kept.first_vertex + size_of(pose)});
    }
    for (const Range& a : ranges) {
      EXPECT_LE(a.end, kBuffer);
      EXPECT_LT(a.buffer, cache.bufferCount());
      for (const Range& b : ranges) {
        const bool same = a.buffer == b.buffer && a.first == b.first && a.end == b.end;
        EXPECT_TRUE(same || a.buffer != b.buffer || a.end <= b.first || b.end <= a.first);
      }
    }
  }
  EXPECT_LE(cache.bufferCount(), 5u) << "9,000 vertices in buffers of 4,000, with gaps";
}

}  // namespace
}  // namespace ensemble
