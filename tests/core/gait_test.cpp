// Legs and steps, of a figure whose steps are known.
#include "core/gait.h"

#include <gtest/gtest.h>

#include "tests/support/stick_walker.h"

namespace ensemble {
namespace {

using namespace testing;

TEST(FindLegs, TellsLegsByTheirShape) {
  const std::optional<Legs> legs = findLegs(stickSkeleton());
  ASSERT_TRUE(legs);
  EXPECT_EQ(legs->legs[0].hip, kHipL);
  EXPECT_EQ(legs->legs[0].knee, kKneeL);
  EXPECT_EQ(legs->legs[0].ankle, kAnkleL);
  EXPECT_EQ(legs->legs[1].hip, kHipR);
  EXPECT_EQ(legs->legs[1].ankle, kAnkleR);
  EXPECT_EQ(legs->legs[1].ankle_position, stickPlaces()[kAnkleR]);
  EXPECT_EQ(legs->groups, (std::vector<std::uint32_t>{0, 0, 1, 2, 3, 3, 4, 5, 6, 6}));
}

TEST(FindLegs, TakesTwistJointsWithTheirBone) {
  RawSkeleton skeleton = stickSkeleton();
  // The left shin hangs on a joint half way down the thigh.
  skeleton.bones.push_back({"twist", static_cast<std::int32_t>(kHipL), {Vec3(0.0f, -0.2f, 0.0f)}});
  skeleton.bones[kKneeL].parent = 10;
  skeleton.joints.push_back({10, Mat4(1.0f)});
  skeleton.joints.back().joint_from_model[3] = Vec4(-0.1f, -0.7f, 0.0f, 1.0f);
  const std::optional<Legs> legs = findLegs(skeleton);
  ASSERT_TRUE(legs);
  EXPECT_EQ(legs->legs[0].hip, kHipL);
  EXPECT_EQ(legs->legs[0].knee, kKneeL);
  EXPECT_EQ(legs->groups[10], 1u);
}

TEST(FindLegs, FindsNoneWhereThereAreNotTwo) {
  EXPECT_FALSE(findLegs(RawSkeleton()));
  RawSkeleton one_legged = stickSkeleton();
  one_legged.joints.resize(kHipR);
  one_legged.bones.resize(kHipR);
  EXPECT_FALSE(findLegs(one_legged));
  RawSkeleton kneeless = stickSkeleton();
  kneeless.bones[kAnkleL].parent = kHipL;
  EXPECT_FALSE(findLegs(kneeless));
}

TEST(AnalyzeGait, FindsWhenFeetStand) {
  const RawSkeleton skeleton = stickSkeleton();
  const Legs legs = *findLegs(skeleton);
  const std::vector<Clip> clips = stickClips(skeleton);
  const std::optional<Gait> gait = analyzeGait(skeleton, legs, clips[0]);
  ASSERT_TRUE(gait);
  EXPECT_NEAR(gait->stride, 2.0f * kStickStep, 1e-5f);
  for (std::size_t foot = 0; foot < 2; ++foot) {
    const float begin = foot == 0 ? 0.0f : 0.5f;
    const Contact& contact = gait->contacts[foot];
    EXPECT_NEAR(contact.begin, begin, 0.02f) << foot;
    EXPECT_NEAR(contact.end, begin + kStickStance, 0.02f) << foot;
    EXPECT_NEAR(contact.middle, begin + 0.5f * kStickStance, 0.02f) << "the feet pass half way";
  }
  EXPECT_FALSE(analyzeGait(skeleton, legs, clips[1])) << "it stands";
}

TEST(AnalyzeGait, PathsAreThoseOfTheClip) {
  const RawSkeleton skeleton = stickSkeleton();
  const auto paths = anklePaths(skeleton, *findLegs(skeleton), stickClips(skeleton)[0]);
  ASSERT_EQ(paths.size(), 61u);
  for (std::size_t key = 0; key < paths.size(); ++key) {
    EXPECT_NEAR(glm::distance(paths[key][0], stickAnkle(static_cast<float>(key) / 60.0f)), 0.0f, 1e-3f)
        << key;
  }
}

}  // namespace
}  // namespace ensemble
