#include "core/clip.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/check.h"
#include "core/gltf_file.h"

namespace ensemble {
namespace {

RawSkeleton chain() {
  RawSkeleton skeleton;
  skeleton.bones.push_back({"root", -1, {{0, 1, 0}, Quat(1, 0, 0, 0), Vec3(1)}});
  skeleton.bones.push_back({"tip", 0, {{0, 0, 2}, Quat(1, 0, 0, 0), Vec3(1)}});
  skeleton.joints.push_back({1, Mat4(1.0f)});
  skeleton.joints[0].joint_from_model[3] = Vec4(0, -1, -2, 1);
  return skeleton;
}

RawChannel channel(ChannelPath path, Interpolation interpolation, std::vector<float> times,
                   std::vector<Vec4> values) {
  return {1, path, interpolation, std::move(times), std::move(values)};
}

Vec4 turn(float angle) { return Vec4(0, std::sin(angle / 2), 0, std::cos(angle / 2)); }

float angleOf(const Transform& transform) {
  return 2 * std::atan2(transform.rotation.y, transform.rotation.w);
}

TEST(SampleClip, KeepsEquallySpacedKeys) {
  const RawClip raw{"c",
                    {channel(ChannelPath::kTranslation, Interpolation::kLinear, {1, 1.25f, 1.501f, 1.75f},
                             {{0, 0, 0, 0}, {1, 0, 0, 0}, {4, 0, 0, 0}, {9, 0, 0, 0}})}};
  const Clip clip = sampleClip(chain(), raw);
  EXPECT_EQ(clip.name, "c");
  EXPECT_EQ(clip.key_count, 4u);
  EXPECT_FLOAT_EQ(clip.seconds, 0.75f);
  for (std::uint32_t key = 0; key < 4; ++key) {
    EXPECT_EQ(clip.key(key)[1].translation.x, static_cast<float>(key * key));  // exactly the file's
    EXPECT_EQ(clip.key(key)[0].translation, Vec3(0, 1, 0));                    // no channel: rest
  }
}

TEST(SampleClip, ThirtyHertzWhereKeysAreNotEquallySpaced) {
  const RawClip raw{"c",
                    {channel(ChannelPath::kTranslation, Interpolation::kLinear, {0, 0.3f, 1},
                             {{0, 0, 0, 0}, {3, 0, 0, 0}, {10, 0, 0, 0}})}};
  const Clip clip = sampleClip(chain(), raw);
  EXPECT_EQ(clip.key_count, 31u);
  EXPECT_FLOAT_EQ(clip.seconds, 1.0f);
  for (std::uint32_t key = 0; key < 31; ++key) {
    EXPECT_NEAR(clip.key(key)[1].translation.x, static_cast<float>(key) / 3.0f, 1e-5f);
  }
}

TEST(SampleClip, ChannelsThinnedOutToTheirEndsFollowTheDensest) {
  const RawClip raw{"c",
                    {channel(ChannelPath::kTranslation, Interpolation::kLinear, {0, 1}, {Vec4(0), Vec4(4)}),
                     channel(ChannelPath::kScale, Interpolation::kLinear, {0, 0.25f, 0.5f, 0.75f, 1},
                             {Vec4(1), Vec4(2), Vec4(1), Vec4(2), Vec4(1)})}};
  const Clip clip = sampleClip(chain(), raw);
  EXPECT_EQ(clip.key_count, 5u);
  EXPECT_EQ(clip.key(3)[1].translation, Vec3(3));
  EXPECT_EQ(clip.key(3)[1].scale, Vec3(2));
}

TEST(SampleClip, SlerpTakesTheShorterArcAtEvenSpeed) {
  // -q is the same rotation as q: without the shorter arc this would go the long way round.
  const RawClip raw{"c",
                    {channel(ChannelPath::kRotation, Interpolation::kLinear, {0, 0.7f, 1},
                             {turn(0), -turn(1.4f), -turn(2.0f)})}};
  const Clip clip = sampleClip(chain(), raw);
  ASSERT_EQ(clip.key_count, 31u);
  for (std::uint32_t key = 0; key <= 30; ++key) {
    const float time = static_cast<float>(key) / 30.0f;
    float angle = angleOf(clip.key(key)[1]);
    if (angle < -1e-4f) angle += 2 * kPi;
    EXPECT_NEAR(std::remainder(angle - 2.0f * time, 2 * kPi), 0.0f, 1e-4f) << key;
    EXPECT_NEAR(glm::length(clip.key(key)[1].rotation), 1.0f, 1e-6f);
  }
}

TEST(SampleClip, StepHolds) {
  const RawClip raw{"c",
                    {channel(ChannelPath::kTranslation, Interpolation::kStep, {0, 0.5f, 1.2f},
                             {Vec4(1), Vec4(2), Vec4(3)})}};
  const Clip clip = sampleClip(chain(), raw);
  ASSERT_EQ(clip.key_count, 37u);
  EXPECT_EQ(clip.key(14)[1].translation, Vec3(1));
  EXPECT_EQ(clip.key(15)[1].translation, Vec3(2));  // 0.5 s exactly: the new value
  EXPECT_EQ(clip.key(35)[1].translation, Vec3(2));
  EXPECT_EQ(clip.key(36)[1].translation, Vec3(3));
}

TEST(SampleClip, CubicSplineFollowsThePolynomial) {
  // x(t) = t^3 - 2 t over [0, 2], which a Hermite spline with the true slopes reproduces.
  const auto x = [](float t) { return t * t * t - 2 * t; };
  const auto slope = [](float t) { return 3 * t * t - 2; };
  std::vector<Vec4> values;
  for (const float t : {0.0f, 2.0f}) {
    values.push_back(Vec4(slope(t), 0, 0, 0));
    values.push_back(Vec4(x(t), 0, 0, 0));
    values.push_back(Vec4(slope(t), 0, 0, 0));
  }
  const RawClip raw{"c", {channel(ChannelPath::kTranslation, Interpolation::kCubicSpline, {0, 2}, values)}};
  const Clip clip = sampleClip(chain(), raw);
  ASSERT_EQ(clip.key_count, 61u);  // a curve: 30 Hz although its two keys are equally spaced
  for (std::uint32_t key = 0; key < 61; ++key) {
    EXPECT_NEAR(clip.key(key)[1].translation.x, x(static_cast<float>(key) / 30.0f), 1e-4f);
  }
}

TEST(SampleClip, OneKeyIsAPose) {
  const RawClip raw{"c", {channel(ChannelPath::kTranslation, Interpolation::kLinear, {3}, {Vec4(5)})}};
  const Clip clip = sampleClip(chain(), raw);
  EXPECT_EQ(clip.key_count, 1u);
  EXPECT_EQ(clip.seconds, 0.0f);
  EXPECT_EQ(clip.key(0)[1].translation, Vec3(5));
  EXPECT_EQ(sampleClip(chain(), {"empty", {}}).key_count, 1u);
}

TEST(SampleClip, ShortChannelsStandStillAtTheirEnds) {
  const RawClip raw{
      "c",
      {channel(ChannelPath::kTranslation, Interpolation::kLinear, {0.4f, 0.6f}, {Vec4(1), Vec4(2)}),
       channel(ChannelPath::kScale, Interpolation::kLinear, {0, 1}, {Vec4(1), Vec4(1)})}};
  const Clip clip = sampleClip(chain(), raw);
  EXPECT_EQ(clip.key(0)[1].translation, Vec3(1));
  EXPECT_EQ(clip.key(clip.key_count - 1)[1].translation, Vec3(2));
}

TEST(SampleClip, ChecksItsCaller) {
  RawClip raw{"c", {channel(ChannelPath::kTranslation, Interpolation::kLinear, {0, 1}, {Vec4(1)})}};
  EXPECT_THROW(sampleClip(chain(), raw), CheckError);
  raw.channels[0].values.push_back(Vec4(1));
  raw.channels[0].bone = 2;
  EXPECT_THROW(sampleClip(chain(), raw), CheckError);
}

TEST(ToRawClip, RoundTrip) {
  const RawSkeleton skeleton = chain();
  Clip clip;
  clip.name = "wave";
  clip.seconds = 0.5f;
  clip.key_count = 6;
  for (int key = 0; key < 6; ++key) {
    std::vector<Transform> pose = restPose(skeleton);
    pose[1].rotation = glm::angleAxis(0.2f * static_cast<float>(key), Vec3(0, 1, 0));
    clip.transforms.insert(clip.transforms.end(), pose.begin(), pose.end());
  }
  const RawClip raw = toRawClip(skeleton, clip);
  ASSERT_EQ(raw.channels.size(), 1u);  // nothing else leaves its rest
  EXPECT_EQ(raw.channels[0].bone, 1u);
  const Clip back = sampleClip(skeleton, raw);
  EXPECT_EQ(back.key_count, 6u);
  EXPECT_EQ(back.seconds, 0.5f);
  for (std::size_t i = 0; i < clip.transforms.size(); ++i) {
    EXPECT_NEAR(std::abs(glm::dot(back.transforms[i].rotation, clip.transforms[i].rotation)), 1.0f, 1e-6f);
  }
}

TEST(ToRawClip, AClipAtRestKeepsItsLength) {
  const RawSkeleton skeleton = chain();
  Clip clip;
  clip.seconds = 2.0f;
  clip.key_count = 3;
  for (int key = 0; key < 3; ++key) {
    const auto rest = restPose(skeleton);
    clip.transforms.insert(clip.transforms.end(), rest.begin(), rest.end());
  }
  const Clip back = sampleClip(skeleton, toRawClip(skeleton, clip));
  EXPECT_EQ(back.key_count, 3u);
  EXPECT_EQ(back.seconds, 2.0f);
}

TEST(Poses, GlobalPoseAndSkinning) {
  const RawSkeleton skeleton = chain();
  std::vector<Transform> local = restPose(skeleton);
  RawVertex vertex;
  vertex.position = Vec3(1, 1, 2);
  vertex.skin = {{0, 0, 0, 0}, {1, 0, 0, 0}};
  EXPECT_EQ(skinPosition(vertex, skinningMatrices(skeleton, local)), vertex.position);
  local[0].rotation = glm::angleAxis(kPi / 2, Vec3(0, 1, 0));  // +Z goes to +X
  std::vector<Mat4> world(2);
  globalPose(skeleton, local, world);
  EXPECT_NEAR(glm::distance(Vec3(world[1][3]), Vec3(2, 1, 0)), 0.0f, 1e-6f);
  EXPECT_NEAR(glm::distance(skinPosition(vertex, skinningMatrices(skeleton, local)), Vec3(2, 1, -1)), 0.0f,
              1e-6f);
  vertex.skin = {};
  EXPECT_EQ(skinPosition(vertex, skinningMatrices(skeleton, local)), vertex.position);
}

TEST(Poses, PeopleWalkAndIdle) {
  const std::filesystem::path people = "../shared/people";
  if (!std::filesystem::exists(people))
    GTEST_SKIP() << people << " is not there: the real people are not tested";
  for (const char* sex : {"female", "male"}) {
    const RawAsset asset = readGltf(people / sex / "template.glb");
    ASSERT_EQ(asset.clips.size(), 2u);
    const Clip walk = sampleClip(asset.skeleton, asset.clips[0]),
               idle = sampleClip(asset.skeleton, asset.clips[1]);
    EXPECT_EQ(walk.name, "walk");
    EXPECT_EQ(walk.key_count, 34u);
    EXPECT_NEAR(walk.seconds, 1.1f, 1e-5f);
    EXPECT_EQ(idle.key_count, 121u);
    EXPECT_NEAR(idle.seconds, 4.0f, 1e-5f);
    for (std::size_t bone = 0; bone < walk.key(0).size(); ++bone) {  // the last key closes the loop
      EXPECT_NEAR(std::abs(glm::dot(walk.key(0)[bone].rotation, walk.key(33)[bone].rotation)), 1.0f, 1e-5f);
    }
    const auto matrices = skinningMatrices(asset.skeleton, restPose(asset.skeleton));
    for (const RawPrimitive& primitive : asset.meshes[0].primitives) {
      for (const RawVertex& vertex : primitive.vertices) {
        EXPECT_NEAR(glm::distance(skinPosition(vertex, matrices), vertex.position), 0.0f, 1e-5f);
      }
    }
  }
}

}  // namespace
}  // namespace ensemble
