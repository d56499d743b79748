// Walking and standing.
#include "assetpipe/people_clips.h"

#include <cstdint>

#include "assetpipe/people_poser.h"

namespace ensemble {
namespace {

constexpr float kWalkSeconds = 1.1f;
constexpr std::uint32_t kWalkKeys = 34;
constexpr float kIdleSeconds = 4.0f;
constexpr std::uint32_t kIdleKeys = 121;

/// Everything above the legs at a phase of the walk.
void poseWalkingTrunk(Poser& poser, float phase) {
  // The pelvis turns forward with the leading leg and dips on the swinging side.
  const float yaw = -5.0f * wave(phase, 0.02f), roll = -3.2f * wave(phase, 0.20f);
  poser.set(kRoot, Quat(1, 0, 0, 0));
  poser.set(kPelvis, turn(yaw, kY) * turn(roll, kZ) * turn(2.0f, kX));
  // The chest turns against it, the head looks ahead.
  poser.set(kSpine1, turn(yaw * 0.4f, kY) * turn(roll * 0.35f, kZ) * turn(2.5f, kX));
  poser.set(kSpine2, turn(yaw * -0.3f, kY) * turn(roll * -0.15f, kZ) * turn(2.6f, kX));
  const Quat chest = turn(yaw * -0.95f, kY) * turn(roll * -0.30f, kZ) * turn(2.4f, kX);
  poser.set(kSpine3, chest);
  poser.set(kNeck, turn(yaw * -0.35f, kY) * turn(1.5f, kX));
  poser.set(kHead, turn(0.8f * wave(2.0f * phase, 0.1f), kX));
  for (const int side : {0, static_cast<int>(kRightArm)}) {
    const float sign = side == 0 ? 1.0f : -1.0f;
    const float swing = -sign * wave(phase, 0.03f);  // against the leg of the same side
    poser.set(kClavicle + side, turn(sign * -3.0f * swing, kY) * chest);
    poseArm(poser, side, {11.0f, 3.0f + 19.0f * swing, 13.0f + 8.0f * swing});
  }
}

}  // namespace

float walkSpeed(const Figure& figure) {
  const AgeGroup age = figure.options.age;
  const float brisk = age == AgeGroup::kOld ? 0.74f : age == AgeGroup::kYoung ? 1.04f : 1.0f;
  return 1.22f * brisk * figure.joints[kThigh].y;
}

Clip makeWalkClip(const Figure& figure, const RawSkeleton& skeleton) {
  Gait gait;
  gait.seconds = kWalkSeconds;
  gait.speed = walkSpeed(figure);
  const float s = figure.scale;
  return makeStrideClip("walk", figure, skeleton, gait, kWalkKeys, [&](Poser& poser, float phase) {
    // Highest in the middle of each stance, over the standing leg.
    poser.movePelvis(Vec3(0.017f * s * wave(phase, 0.30f), -0.022f * s * wave(2.0f * phase, 0.14f),
                          0.006f * s * wave(2.0f * phase, 0.0f)));
    poseWalkingTrunk(poser, phase);
  });
}

Clip makeIdleClip(const Figure& figure, const RawSkeleton& skeleton) {
  const float s = figure.scale;
  constexpr std::uint32_t kSteps = kIdleKeys - 1;
  std::vector<std::vector<Transform>> keys;
  for (std::uint32_t key = 0; key < kSteps; ++key) {
    const float phase = static_cast<float>(key) / static_cast<float>(kSteps);
    const float breath = wave(phase, 0.45f), shift = wave(phase, 0.15f);
    Poser poser(figure, skeleton);
    poser.movePelvis(s * Vec3(0.004f + 0.012f * shift, -0.012f, -0.004f));
    poser.set(kRoot, Quat(1, 0, 0, 0));
    poser.set(kPelvis, turn(1.6f * shift + 0.5f, kZ) * turn(1.0f, kY));
    poser.set(kSpine1, turn(0.4f * shift, kZ) * turn(0.4f, kX));
    poser.set(kSpine2, turn(-0.8f * shift, kZ) * turn(0.3f - 0.5f * breath, kX));
    const Quat chest = turn(-1.2f * shift, kZ) * turn(0.5f - 1.1f * breath, kX);
    poser.set(kSpine3, chest);
    poser.set(kNeck, turn(2.0f * wave(phase, 0.7f), kY) * turn(1.0f, kX));
    poser.set(kHead, turn(4.0f * wave(phase, 0.7f), kY) * turn(0.8f * wave(phase, 0.3f), kX));
    for (const int side : {0, static_cast<int>(kRightArm)}) {
      const float sign = side == 0 ? 1.0f : -1.0f;
      poser.set(kClavicle + side, turn(sign * 1.3f * (breath - 1.0f), kZ) * chest);
      poseArm(poser, side, {10.0f + 0.6f * breath, 2.0f + 1.2f * wave(phase, 0.55f) * sign, 14.0f + breath});
    }
    for (const int side : {0, static_cast<int>(kRightLeg)}) {
      poser.placeAnkle(side, figure.joints[static_cast<std::size_t>(kFoot) + static_cast<std::size_t>(side)]);
      poser.set(kFoot + side, Quat(1, 0, 0, 0));
      poser.set(kBall + side, Quat(1, 0, 0, 0));
    }
    keys.push_back(poser.local());
  }
  return toClip("idle", kIdleSeconds, keys);
}

std::vector<Clip> makeClips(const Figure& figure, const RawSkeleton& skeleton) {
  return {makeWalkClip(figure, skeleton), makeRunClip(figure, skeleton), makeIdleClip(figure, skeleton),
          makeTalkClip(figure, skeleton), makeCheerClip(figure, skeleton)};
}

}  // namespace ensemble
