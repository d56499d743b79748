// Running: as walking, with a short stance, a flight after each, and bent arms.
#include <cstdint>

#include "assetpipe/people_clips.h"
#include "assetpipe/people_poser.h"

namespace ensemble {
namespace {

constexpr float kRunSeconds = 0.7f;
constexpr std::uint32_t kRunKeys = 43;

Gait runGait(const Figure& figure) {
  Gait gait;
  gait.seconds = kRunSeconds;
  gait.speed = runSpeed(figure);
  gait.toe_off = 0.34f;
  gait.flat = 0.05f;
  gait.heel_off = 0.15f;
  gait.strike_pitch = -7.0f;
  gait.toe_off_pitch = 62.0f;
  gait.swing_pitch = 38.0f;
  gait.lift = 0.165f;
  gait.early_lift = 1.2f;
  gait.middle = 0.142f;
  gait.narrow = 0.34f;
  return gait;
}

/// Pelvis and all above the legs; phase 0 is the left foot's strike.
void poseRunner(Poser& poser, const Figure& figure, float phase) {
  const float s = figure.scale;
  // Lowest while a foot carries, highest in the flight after it.
  poser.movePelvis(s * Vec3(0.010f * wave(phase, 0.18f), -0.032f * wave(2.0f * phase, 0.32f) - 0.012f,
                            0.010f * wave(2.0f * phase, 0.1f)));
  const float yaw = -8.0f * wave(phase, 0.98f), roll = -3.5f * wave(phase, 0.16f);
  poser.set(kRoot, Quat(1, 0, 0, 0));
  poser.set(kPelvis, turn(yaw, kY) * turn(roll, kZ) * turn(8.0f, kX));
  poser.set(kSpine1, turn(yaw * 0.4f, kY) * turn(roll * 0.3f, kZ) * turn(8.0f, kX));
  poser.set(kSpine2, turn(yaw * -0.4f, kY) * turn(8.5f, kX));
  const Quat chest =
      turn(yaw * -1.2f, kY) * turn(roll * -0.3f, kZ) * turn(8.0f + 1.2f * wave(2.0f * phase, 0.34f), kX);
  poser.set(kSpine3, chest);
  poser.set(kNeck, turn(yaw * -0.3f, kY) * turn(3.0f, kX));
  poser.set(kHead, turn(1.0f + 1.5f * wave(2.0f * phase, 0.40f), kX));
  for (const int side : {0, static_cast<int>(kRightArm)}) {
    const float sign = side == 0 ? 1.0f : -1.0f;
    const float swing = -sign * wave(phase, 0.97f);  // against the leg of the same side
    poser.set(kClavicle + side, turn(sign * -6.0f * swing, kY) * turn(sign * 2.0f, kZ) * chest);
    poseArm(poser, side, {15.0f, -8.0f + 34.0f * swing, 84.0f + 14.0f * swing, -4.0f, 2.6f});
  }
}

}  // namespace

float runSpeed(const Figure& figure) {
  const float brisk = figure.options.age == AgeGroup::kOld ? 0.72f : 1.0f;
  return 2.9f * brisk * figure.joints[kThigh].y;
}

Clip makeRunClip(const Figure& figure, const RawSkeleton& skeleton) {
  return makeStrideClip("run", figure, skeleton, runGait(figure), kRunKeys,
                        [&](Poser& poser, float phase) { poseRunner(poser, figure, phase); });
}

}  // namespace ensemble
