// Root motion: a walk that was given travel comes back as the walk in place.
#include "assetpipe/root_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "assetpipe/ground_speed.h"
#include "assetpipe/people_clips.h"
#include "assetpipe/pipeline.h"
#include "core/atomic_file.h"
#include "core/gltf_file.h"
#include "tests/support/small_people.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A made person's walk and idle, in place.
class RootMotion : public ::testing::Test {
 protected:
  const RawSkeleton& skeleton() const { return skeleton_; }
  Clip walk() const { return makeWalkClip(figure_, skeleton_); }
  Clip idle() const { return makeIdleClip(figure_, skeleton_); }
  static constexpr std::size_t kRootBone = 0, kPelvisBone = 1;

  /// Adds `velocity` (X, Z) to a bone, in its parent's frame as that stands at each key.
  static Clip travelling(const RawSkeleton& skeleton, Clip clip, std::size_t bone, Vec2 velocity) {
    std::vector<Mat4> world_from_bone(skeleton.bones.size());
    for (std::uint32_t key = 0; key < clip.key_count; ++key) {
      globalPose(skeleton, clip.key(key), world_from_bone);
      const float seconds = clip.seconds * static_cast<float>(key) / static_cast<float>(clip.key_count - 1);
      const Vec3 way(seconds * velocity.x, 0.0f, seconds * velocity.y);
      const std::int32_t parent = skeleton.bones[bone].parent;
      clip.transforms[key * skeleton.bones.size() + bone].translation +=
          parent < 0 ? way : glm::inverse(Mat3(world_from_bone[static_cast<std::size_t>(parent)])) * way;
    }
    return clip;
  }

  static void expectSame(const RawSkeleton& skeleton, const Clip& clip, const Clip& expected) {
    ASSERT_EQ(clip.key_count, expected.key_count);
    for (std::uint32_t key = 0; key < clip.key_count; ++key) {
      const std::vector<Mat4> here = skinningMatrices(skeleton, clip.key(key));
      const std::vector<Mat4> there = skinningMatrices(skeleton, expected.key(key));
      for (std::size_t joint = 0; joint < here.size(); ++joint) {
        for (int column = 0; column < 4; ++column)
          ASSERT_NEAR(glm::distance(here[joint][column], there[joint][column]), 0.0f, 1e-4f)
              << "key " << key << " joint " << joint;
      }
    }
  }

 private:
  const Figure figure_ = makeFigure({.sex = Sex::kFemale, .height = 1.67f});
  const RawSkeleton skeleton_ = makeSkeleton(figure_);
};

TEST_F(RootMotion, ClipsInPlaceAreNotTouched) {
  for (const Clip& clip : {walk(), idle()}) {
    Clip same = clip;
    EXPECT_EQ(takeOutRootMotion(skeleton(), same), Vec2(0.0f)) << clip.name;
    for (std::size_t i = 0; i < clip.transforms.size(); ++i)
      ASSERT_EQ(same.transforms[i].translation, clip.transforms[i].translation);
  }
}

TEST_F(RootMotion, TravelOfTheRootOrTheHipsComesOut) {
  const Clip in_place = walk();
  const float speed = groundSpeed(skeleton(), in_place);
  for (const std::size_t bone : {kRootBone, kPelvisBone}) {
    for (const Vec2 velocity : {Vec2(0, speed), Vec2(speed, 0), Vec2(-0.6f, -0.8f), Vec2(0, 0.001f)}) {
      Clip clip = travelling(skeleton(), in_place, bone, velocity);
      const Vec2 taken = takeOutRootMotion(skeleton(), clip);
      EXPECT_NEAR(glm::distance(taken, velocity), 0.0f, 1e-5f);
      expectSame(skeleton(), clip, in_place);
      const Transform &first = clip.key(0)[bone], &last = clip.key(clip.key_count - 1)[bone];
      EXPECT_NEAR(glm::distance(first.translation, last.translation), 0.0f, 1e-5f);
    }
  }
  EXPECT_EQ(travelling(skeleton(), in_place, kPelvisBone, {0, 1}).key(3)[kRootBone].translation,
            in_place.key(3)[kRootBone].translation)
      << "a root that stands still is not what travels";
}

TEST_F(RootMotion, TheWalksOwnSpeedIsKept) {
  Clip clip = walk();
  std::vector<std::string> warnings;
  putInPlace(skeleton(), clip, warnings);
  const float in_place = clip.ground_speed;
  EXPECT_GT(in_place, 0.8f);
  // Made to travel as fast as its feet walk, so that they stand on a ground that rests.
  clip = travelling(skeleton(), walk(), kPelvisBone, {0, in_place});
  putInPlace(skeleton(), clip, warnings);
  EXPECT_NEAR(clip.ground_speed, in_place, 0.01f * in_place);
  EXPECT_THAT(warnings, IsEmpty());
}

TEST_F(RootMotion, HeightStays) {
  Clip clip = travelling(skeleton(), walk(), kPelvisBone, {0, 1});
  for (std::uint32_t key = 0; key < clip.key_count; ++key)
    clip.transforms[key * skeleton().bones.size() + kRootBone].translation.y +=
        0.01f * static_cast<float>(key);
  const Clip climbing = clip;
  takeOutRootMotion(skeleton(), clip);
  for (std::uint32_t key = 0; key < clip.key_count; ++key) {
    const std::vector<Mat4> here = skinningMatrices(skeleton(), clip.key(key));
    const std::vector<Mat4> there = skinningMatrices(skeleton(), climbing.key(key));
    EXPECT_NEAR(here[kPelvisBone][3].y, there[kPelvisBone][3].y, 1e-5f);
  }
}

TEST_F(RootMotion, AnIdleClipThatDriftsStands) {
  Clip clip = travelling(skeleton(), idle(), kRootBone, {0.03f, 0.02f});
  std::vector<std::string> warnings;
  putInPlace(skeleton(), clip, warnings);
  EXPECT_EQ(clip.ground_speed, 0.0f);
  EXPECT_THAT(warnings, IsEmpty());
  expectSame(skeleton(), clip, idle());
}

/// As Mixamo and Blender write it: a node above that turns and scales, the joints in centimetres.
TEST_F(RootMotion, AParentMayTurnAndScale) {
  RawSkeleton scaled;
  const Transform armature{Vec3(0.0f), glm::angleAxis(radians(90.0f), Vec3(1, 0, 0)), Vec3(0.01f)};
  scaled.bones.push_back({"Armature", -1, armature});
  const Mat4 root = glm::inverse(toMatrix(armature));
  Clip original = walk(), clip = original;
  clip.transforms.clear();
  for (const RawBone& bone : skeleton().bones)
    scaled.bones.push_back({bone.name, bone.parent + 1, bone.rest});
  for (RawJoint joint : skeleton().joints) {
    ++joint.bone;
    scaled.joints.push_back(joint);
  }
  for (std::uint32_t key = 0; key < clip.key_count; ++key) {
    clip.transforms.push_back(armature);
    for (const Transform& local : original.key(key)) clip.transforms.push_back(local);
    Transform& top = clip.transforms[key * scaled.bones.size() + 1];
    top = toTransform(root * toMatrix(top));
  }
  expectSame(scaled, clip, clip);
  Clip travels = travelling(scaled, clip, 2, {0.0f, 1.3f});
  const Vec2 taken = takeOutRootMotion(scaled, travels);
  EXPECT_NEAR(taken.y, 1.3f, 1e-4f);
  expectSame(scaled, travels, clip);
}

/// Rigs for games have targets beside the hips that travel along; what stands in the world stays.
TEST_F(RootMotion, TargetsThatTravelAlongDoSo) {
  RawSkeleton rig = skeleton();
  const auto along = static_cast<std::uint32_t>(rig.bones.size());
  rig.bones.push_back({"ik_foot_l", 0, {}});
  rig.bones.push_back({"camera", 0, {}});
  rig.joints.push_back({along, Mat4(1.0f)});
  rig.joints.push_back({along + 1, Mat4(1.0f)});
  Clip in_place = walk();
  std::vector<Transform> transforms;
  for (std::uint32_t key = 0; key < in_place.key_count; ++key) {
    for (const Transform& local : in_place.key(key)) transforms.push_back(local);
    transforms.push_back({});
    transforms.push_back({});
  }
  in_place.transforms = transforms;
  Clip clip = travelling(rig, travelling(rig, in_place, kPelvisBone, {0, 1}), along, {0, 1});
  takeOutRootMotion(rig, clip);
  expectSame(rig, clip, in_place);
}

TEST_F(RootMotion, OtherDirectionsAndSlidingFeetAreTold) {
  std::vector<std::string> warnings;
  Clip strafe = travelling(skeleton(), walk(), kRootBone, {groundSpeed(skeleton(), walk()), 0.0f});
  putInPlace(skeleton(), strafe, warnings);
  EXPECT_THAT(
      warnings,
      ElementsAre("clip 'walk' travels at 90 degrees to the direction that the figure faces; it keeps "
                  "its heading, and slides sideways where people follow a path"));
  warnings.clear();
  Clip skating = travelling(skeleton(), idle(), kRootBone, {0.0f, 0.5f});
  putInPlace(skeleton(), skating, warnings);
  EXPECT_THAT(warnings,
              ElementsAre("clip 'idle' travels at 0.50 m/s, but its feet stand on a ground that moves "
                          "at 0.00 m/s; feet will slide"));
}

TEST_F(RootMotion, AClipOfOneKeyHasNone) {
  Clip clip = walk();
  clip.key_count = 1;
  clip.transforms.resize(skeleton().bones.size());
  EXPECT_EQ(takeOutRootMotion(skeleton(), clip), Vec2(0.0f));
  EXPECT_EQ(takeOutRootMotion({}, clip), Vec2(0.0f));
}

/// Through files: the template's own clip and one of `--clips` travel, the wardrobe's stand.
TEST_F(RootMotion, TagPutsClipsInPlace) {
  const testing::TemporaryFolder folder;
  const Clip in_place = walk();
  const Clip travels = travelling(skeleton(), in_place, kPelvisBone, {0.0f, 1.2f});
  RawAsset body = testing::tubeTemplate();  // skinned to the first two joints
  body.skeleton = skeleton();
  body.clips = {toRawClip(skeleton(), travels)};
  writeFileAtomically(folder / "template.glb", writeGlb(body));
  body.clips[0].name = "mixamo.com";
  writeFileAtomically(folder / "stroll.glb", writeGlb(body));
  PipelineOptions options;
  options.clips = {folder / "stroll.glb"};
  const Manifest manifest = tagWardrobe(folder / "template.glb", {}, folder / "w", options);
  ASSERT_EQ(manifest.body.clips.size(), 2u);
  const TemplateBody loaded = loadWardrobe(folder / "w").body;
  for (std::size_t c = 0; c < 2; ++c) {
    EXPECT_NEAR(manifest.body.clips[c].ground_speed, 1.2f, 0.012f);
    EXPECT_NEAR(loaded.clips[c].ground_speed, 1.2f, 0.012f);
    expectSame(loaded.skeleton, loaded.clips[c], in_place);
  }
}

}  // namespace
}  // namespace ensemble
