// Standing people who do something with their hands: talking and cheering.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "assetpipe/people_clips.h"
#include "assetpipe/people_poser.h"

namespace ensemble {
namespace {

// At 30 Hz: 6 s and 1.6 s.
constexpr std::uint32_t kTalkKeys = 181, kCheerKeys = 49;

/// 1 from `from` to `to`, 0 elsewhere, eased over `ease`; parts of a clip that loops.
float during(float phase, float from, float to, float ease) {
  float result = 0.0f;
  for (const float turn_of_clip : {-1.0f, 0.0f, 1.0f}) {
    const float t = phase + turn_of_clip;
    result = std::max(result, smoothStep(from - ease, from + ease, t) - smoothStep(to - ease, to + ease, t));
  }
  return result;
}

void standStill(Poser& poser, const Figure& figure) {
  for (const int side : {0, static_cast<int>(kRightLeg)}) {
    poser.placeAnkle(side, figure.joints[static_cast<std::size_t>(kFoot) + static_cast<std::size_t>(side)]);
    poser.set(kFoot + side, Quat(1, 0, 0, 0));
    poser.set(kBall + side, Quat(1, 0, 0, 0));
  }
}

ArmAngles between(const ArmAngles& a, const ArmAngles& b, float part) {
  return {std::lerp(a.outward, b.outward, part), std::lerp(a.forward, b.forward, part),
          std::lerp(a.elbow, b.elbow, part), std::lerp(a.twist, b.twist, part),
          std::lerp(a.curl, b.curl, part)};
}

void poseTalker(Poser& poser, const Figure& figure, float phase) {
  const float s = figure.scale;
  const float shift = wave(phase, 0.3f), breath = wave(3.0f * phase, 0.2f);
  // Three times the right hand stresses a word, once both do.
  const float right = std::max({during(phase, 0.08f, 0.30f, 0.035f), during(phase, 0.40f, 0.52f, 0.035f),
                                during(phase, 0.62f, 0.86f, 0.040f)});
  const float left = during(phase, 0.62f, 0.84f, 0.045f);
  const float beat = wave(9.0f * phase, 0.1f), slow = wave(4.0f * phase, 0.4f);
  poser.movePelvis(s * Vec3(-0.006f + 0.014f * shift, -0.014f, 0.004f * left));
  poser.set(kRoot, Quat(1, 0, 0, 0));
  poser.set(kPelvis, turn(1.8f * shift, kZ) * turn(-1.5f + 2.0f * left, kY));
  poser.set(kSpine1, turn(0.5f * shift, kZ) * turn(1.0f + 1.0f * left, kX));
  poser.set(kSpine2, turn(-0.9f * shift, kZ) * turn(2.0f * right - left, kY) * turn(1.0f + 1.5f * left, kX));
  const Quat chest = turn(-1.4f * shift, kZ) * turn(4.0f * right - 3.0f * left, kY) *
                     turn(1.0f - 0.8f * breath + 2.0f * left, kX);
  poser.set(kSpine3, chest);
  const float look = 9.0f * wave(phase, 0.55f) + 4.0f * wave(2.0f * phase, 0.2f);
  const float nod = 3.0f * beat * right + 2.0f * slow;
  poser.set(kNeck, turn(0.4f * look, kY) * turn(1.0f + 0.4f * nod, kX));
  poser.set(kHead, turn(look, kY) * turn(2.5f * wave(phase, 0.8f), kZ) * turn(nod, kX));
  const ArmAngles hanging{10.0f + 0.6f * breath, 3.0f, 16.0f, -14.0f, 1.0f};
  const ArmAngles telling{15.0f + 3.0f * slow, 22.0f + 5.0f * beat, 84.0f - 11.0f * beat, 34.0f, 0.45f};
  const ArmAngles open{26.0f + 4.0f * beat, 20.0f + 4.0f * slow, 76.0f - 8.0f * beat, 48.0f, 0.25f};
  for (const int side : {0, static_cast<int>(kRightArm)}) {
    const float sign = side == 0 ? 1.0f : -1.0f, raised = side == 0 ? left : right;
    poser.set(kClavicle + side, turn(sign * (1.2f * (breath - 1.0f) + 2.0f * raised), kZ) * chest);
    poseArm(poser, side, between(hanging, between(telling, open, left), raised));
  }
}

void poseCheerer(Poser& poser, const Figure& figure, float phase) {
  const float s = figure.scale;
  // Two bounces a clip; the arms go highest as the knees straighten.
  const float bounce = wave(2.0f * phase, 0.0f), sway = wave(phase, 0.1f);
  poser.movePelvis(s * Vec3(0.012f * sway, -0.045f + 0.030f * bounce, -0.006f));
  poser.set(kRoot, Quat(1, 0, 0, 0));
  poser.set(kPelvis, turn(2.0f * sway, kZ) * turn(4.0f * sway, kY));
  poser.set(kSpine1, turn(1.0f * sway, kZ) * turn(-1.0f - 1.0f * bounce, kX));
  poser.set(kSpine2, turn(-1.0f * sway, kZ) * turn(-2.0f - 1.5f * bounce, kX));
  const Quat chest = turn(-2.5f * sway, kZ) * turn(-3.0f * sway, kY) * turn(-4.0f - 2.0f * bounce, kX);
  poser.set(kSpine3, chest);
  poser.set(kNeck, turn(-1.0f * sway, kZ) * turn(-4.0f, kX));
  poser.set(kHead, turn(5.0f * sway, kY) * turn(-7.0f - 3.0f * wave(2.0f * phase, 0.15f), kX));
  for (const int side : {0, static_cast<int>(kRightArm)}) {
    const float sign = side == 0 ? 1.0f : -1.0f;
    const float pump = wave(2.0f * phase, side == 0 ? 0.02f : 0.12f);
    poser.set(kClavicle + side, turn(sign * (19.0f + 4.0f * pump), kZ) * chest);
    poseArm(poser, side, {128.0f + 7.0f * pump, 14.0f - 5.0f * pump, 36.0f - 18.0f * pump, 12.0f, 2.7f});
  }
}

template <class Pose>
Clip standingClip(const Figure& figure, const RawSkeleton& skeleton, const char* name,
                  std::uint32_t keys_wanted, const Pose& pose) {
  const std::uint32_t steps = keys_wanted - 1;
  std::vector<std::vector<Transform>> keys;
  for (std::uint32_t key = 0; key < steps; ++key) {
    Poser poser(figure, skeleton);
    pose(poser, figure, static_cast<float>(key) / static_cast<float>(steps));
    standStill(poser, figure);
    keys.push_back(poser.local());
  }
  return toClip(name, static_cast<float>(steps) / 30.0f, keys);
}

}  // namespace

Clip makeTalkClip(const Figure& figure, const RawSkeleton& skeleton) {
  return standingClip(figure, skeleton, "talk", kTalkKeys, poseTalker);
}

Clip makeCheerClip(const Figure& figure, const RawSkeleton& skeleton) {
  return standingClip(figure, skeleton, "cheer", kCheerKeys, poseCheerer);
}

}  // namespace ensemble
