#include "renderer/own_poses.h"

#include <gtest/gtest.h>

namespace ensemble {
namespace {

TEST(OwnPoses, LieSideBySideAndGoOnInTheNextBuffer) {
  OwnPoses poses(5, 100);
  const auto require = [&](std::uint32_t person, std::uint32_t count) {
    return poses.require(person, count);
  };
  EXPECT_EQ(require(3, 40).first_vertex, 0u);
  EXPECT_EQ(require(1, 60).first_vertex, 40u);
  const OwnPose third = require(4, 1);
  EXPECT_EQ(third.buffer, 1u);
  EXPECT_EQ(third.first_vertex, 0u);
  EXPECT_TRUE(third.is_new);
  EXPECT_EQ(poses.vertexCount(), 101u);
  EXPECT_EQ(poses.count(), 3u);
}

TEST(OwnPoses, StayWhereTheyAreForAFrame) {
  OwnPoses poses(2, 100);
  poses.beginFrame();
  EXPECT_TRUE(poses.require(1, 30).is_new);
  poses.require(0, 30);
  const OwnPose again = poses.require(1, 30);
  EXPECT_FALSE(again.is_new);
  EXPECT_EQ(again.first_vertex, 0u);
  EXPECT_EQ(poses.count(), 2u);
  poses.beginFrame();
  EXPECT_EQ(poses.count(), 0u);
  const OwnPose anew = poses.require(0, 30);
  EXPECT_TRUE(anew.is_new);
  EXPECT_EQ(anew.first_vertex, 0u);
}

}  // namespace
}  // namespace ensemble
