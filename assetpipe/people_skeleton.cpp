#include <array>
#include <string>
#include <string_view>

#include "assetpipe/people_figure.h"
#include "core/check.h"

namespace ensemble {
namespace {

constexpr std::array<std::string_view, kBodyJointCount> kNames = {
    "Root",        "pelvis",     "spine_01",   "spine_02",    "spine_03",    "clavicle_l",  "upperarm_l",
    "lowerarm_l",  "hand_l",     "index_01_l", "index_02_l",  "index_03_l",  "middle_01_l", "middle_02_l",
    "middle_03_l", "pinky_01_l", "pinky_02_l", "pinky_03_l",  "ring_01_l",   "ring_02_l",   "ring_03_l",
    "thumb_01_l",  "thumb_02_l", "thumb_03_l", "clavicle_r",  "upperarm_r",  "lowerarm_r",  "hand_r",
    "index_01_r",  "index_02_r", "index_03_r", "middle_01_r", "middle_02_r", "middle_03_r", "pinky_01_r",
    "pinky_02_r",  "pinky_03_r", "ring_01_r",  "ring_02_r",   "ring_03_r",   "thumb_01_r",  "thumb_02_r",
    "thumb_03_r",  "neck_01",    "head",       "thigh_l",     "calf_l",      "foot_l",      "ball_l",
    "thigh_r",     "calf_r",     "foot_r",     "ball_r"};

}  // namespace

std::string_view jointName(std::uint16_t joint) {
  ENSEMBLE_CHECK(joint < kBodyJointCount);
  return kNames[joint];
}

std::int32_t jointParent(std::uint16_t joint) {
  if (joint == kRoot) return -1;
  if (joint <= kSpine3) return joint - 1;
  if (joint == kNeck) return kSpine3;
  if (joint == kHead) return kNeck;
  if (joint >= kThigh) {
    const int within = (joint - kThigh) % kRightLeg;
    return within == 0 ? kPelvis : joint - 1;
  }
  const int within = (joint - kClavicle) % kRightArm;
  if (within == 0) return kSpine3;
  if (within <= kHand - kClavicle) return joint - 1;
  const bool is_first_phalanx = (within - (kIndex1 - kClavicle)) % 3 == 0;
  return is_first_phalanx ? joint - within + (kHand - kClavicle) : joint - 1;
}

RawSkeleton makeSkeleton(const Figure& figure) {
  RawSkeleton skeleton;
  std::array<Mat4, kBodyJointCount> model_from_bone;
  for (std::uint16_t j = 0; j < kBodyJointCount; ++j) {
    // A bone points to its first child; the last of a chain goes on as its parent does.
    Vec3 along(0.0f, 1.0f, 0.0f);
    const std::int32_t parent = jointParent(j);
    std::int32_t child = -1;
    for (std::uint16_t c = kBodyJointCount - 1; c > j; --c) {
      if (jointParent(c) == j) child = c;
    }
    if (j == kSpine3) child = kNeck;
    if (j == kHand || j == kHand + kRightArm) child = j + (kMiddle1 - kHand);
    if (j == kHead) {
      along = figure.head_top - figure.joints[j];
    } else if (j == kBall || j == kBall + kRightLeg) {
      along = {0.0f, 0.0f, 1.0f};
    } else if (j != kRoot && j != kPelvis) {
      along = child >= 0 ? figure.joints[child] - figure.joints[j] : figure.joints[j] - figure.joints[parent];
    }
    const Vec3 front = j == kFoot || j == kFoot + kRightLeg || j == kBall || j == kBall + kRightLeg
                           ? Vec3(0.0f, 1.0f, 0.0f)
                           : Vec3(0.0f, 0.0f, 1.0f);
    const LoftFrame frame = loftFrame(figure.joints[j], figure.joints[j] + along, front);
    const Quat turn = j == kRoot ? Quat(1, 0, 0, 0) : glm::normalize(glm::quat_cast(frame.world_from_local));
    Mat4 here = glm::mat4_cast(turn);
    here[3] = Vec4(figure.joints[j], 1.0f);
    model_from_bone[j] = here;
    const Mat4 local = parent < 0 ? here : glm::inverse(model_from_bone[parent]) * here;
    RawBone bone;
    bone.name = std::string(jointName(j));
    bone.parent = parent;
    bone.rest = {Vec3(local[3]), glm::normalize(glm::quat_cast(Mat3(local))), Vec3(1.0f)};
    skeleton.bones.push_back(bone);
    skeleton.joints.push_back({j, glm::inverse(here)});
  }
  return skeleton;
}

}  // namespace ensemble
