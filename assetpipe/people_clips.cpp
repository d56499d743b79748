// A pose is told by how far each bone is turned from rest, in model space; what is not told follows
// its parent. Legs are solved from where pelvis and ankles are (two bones, closed form).
#include "assetpipe/people_clips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/check.h"

namespace ensemble {
namespace {

constexpr float kWalkSeconds = 1.1f;
constexpr std::uint32_t kWalkKeys = 34;
constexpr float kIdleSeconds = 4.0f;
constexpr std::uint32_t kIdleKeys = 121;

Quat turn(float angle_degrees, const Vec3& axis) { return glm::angleAxis(radians(angle_degrees), axis); }
const Vec3 kX(1.0f, 0.0f, 0.0f), kY(0.0f, 1.0f, 0.0f), kZ(0.0f, 0.0f, 1.0f);

/// A wave of period 1 that is 1 at `peak`.
float wave(float phase, float peak = 0.0f) { return std::cos(2.0f * kPi * (phase - peak)); }

/// The frame of a limb: y along it, z as near to the pole as can be.
Mat3 limbFrame(const Vec3& along, const Vec3& pole) {
  const Vec3 y = glm::normalize(along);
  const Vec3 x = glm::normalize(glm::cross(y, pole));
  return Mat3(x, y, glm::cross(x, y));
}

class Poser {
 public:
  Poser(const Figure& figure, const RawSkeleton& skeleton) : f_(figure), skeleton_(skeleton) {
    pelvis_ = f_.joints[kPelvis];
  }

  const Vec3& restJoint(int index) const { return f_.joints[static_cast<std::size_t>(index)]; }
  void movePelvis(const Vec3& offset) { pelvis_ = restJoint(kPelvis) + offset; }

  /// Turns a bone, in model space, on top of what its parent does. Parents first.
  void bend(int index, const Quat& by) { set(index, by * inherited(index)); }
  /// Turns a bone from rest, in model space, whatever its parent does.
  void set(int index, const Quat& from_rest) {
    turned_[static_cast<std::size_t>(index)] = from_rest;
    is_set_[static_cast<std::size_t>(index)] = true;
  }
  Quat turned(int index) const {
    return is_set_[static_cast<std::size_t>(index)] ? turned_[static_cast<std::size_t>(index)]
                                                    : inherited(index);
  }

  /// Bends a leg so that the ankle comes to `ankle` (or as near as it reaches), knee to the front.
  void placeAnkle(int side, const Vec3& ankle) {
    const int thigh = kThigh + side, calf = kCalf + side, foot = kFoot + side;
    const Vec3 hip = pelvis_ + turned(kPelvis) * (restJoint(thigh) - restJoint(kPelvis));
    const Vec3 upper = restJoint(calf) - restJoint(thigh), lower = restJoint(foot) - restJoint(calf);
    const float a = glm::length(upper), b = glm::length(lower);
    const Vec3 reach = ankle - hip;
    const float d = std::min(glm::length(reach), 0.9995f * (a + b));
    const Vec3 way = glm::normalize(reach);
    const Vec3 front = turned(kPelvis) * kZ + Vec3(side == 0 ? 0.10f : -0.10f, 0.0f, 0.0f);
    const Vec3 pole = glm::normalize(front - way * glm::dot(front, way));
    const float cosine = std::clamp((a * a + d * d - b * b) / (2.0f * a * d), -1.0f, 1.0f);
    const Vec3 knee = a * (cosine * way + std::sqrt(1.0f - cosine * cosine) * pole);
    set(thigh, glm::quat_cast(limbFrame(knee, pole) * glm::transpose(limbFrame(upper, kZ))));
    set(calf, glm::quat_cast(limbFrame(d * way - knee, pole) * glm::transpose(limbFrame(lower, kZ))));
  }

  float legReach() const {
    return glm::distance(restJoint(kThigh), restJoint(kCalf)) +
           glm::distance(restJoint(kCalf), restJoint(kFoot));
  }
  Vec3 hip(int side) const {
    return pelvis_ + turned(kPelvis) * (restJoint(kThigh + side) - restJoint(kPelvis));
  }

  /// Local transforms of every bone.
  std::vector<Transform> local() const {
    std::vector<Transform> result = restPose(skeleton_);
    for (int j = 0; j < kBodyJointCount; ++j) {
      const std::int32_t parent = jointParent(static_cast<std::uint16_t>(j));
      if (parent < 0) continue;
      const Quat world = turned(j) * restWorld(j), above = turned(parent) * restWorld(parent);
      result[static_cast<std::size_t>(j)].rotation = glm::normalize(glm::conjugate(above) * world);
    }
    result[kPelvis].translation += pelvis_ - restJoint(kPelvis);  // the root stands unturned at the origin
    return result;
  }

 private:
  Quat inherited(int index) const {
    const std::int32_t parent = jointParent(static_cast<std::uint16_t>(index));
    return parent < 0 ? Quat(1, 0, 0, 0) : turned(parent);
  }
  Quat restWorld(int index) const {
    Quat world = skeleton_.bones[static_cast<std::size_t>(index)].rest.rotation;
    for (std::int32_t p = jointParent(static_cast<std::uint16_t>(index)); p >= 0;
         p = jointParent(static_cast<std::uint16_t>(p))) {
      world = skeleton_.bones[static_cast<std::size_t>(p)].rest.rotation * world;
    }
    return world;
  }

  const Figure& f_;
  const RawSkeleton& skeleton_;
  Vec3 pelvis_;
  std::array<Quat, kBodyJointCount> turned_{};
  std::array<bool, kBodyJointCount> is_set_{};
};

/// Arm angles in degrees: from vertical outwards, forwards, and the elbow's bend.
struct ArmAngles {
  float outward = 10.0f, forward = 0.0f, elbow = 15.0f;
};

/// An arm let down from the A-pose. `body` is how the chest is turned.
void poseArm(Poser& poser, int side, const ArmAngles& angles) {
  const float sign = side == 0 ? 1.0f : -1.0f;
  const Vec3 upper = poser.restJoint(kLowerArm + side) - poser.restJoint(kUpperArm + side);
  const Vec3 lower = poser.restJoint(kHand + side) - poser.restJoint(kLowerArm + side);
  const float rest_outward = degrees(std::atan2(std::abs(upper.x), -upper.y));
  const Quat down = turn(sign * (angles.outward - rest_outward), kZ);
  const Quat swing = turn(-angles.forward, kX);
  const Quat chest = poser.turned(kSpine3);
  const Quat raised = chest * swing * down;
  poser.set(kUpperArm + side, raised);
  // The elbow closes towards the front; the forearm turns the palm a little backwards.
  const Vec3 hinge = glm::normalize(glm::cross(upper, kZ));
  const Quat bent = raised * glm::angleAxis(radians(angles.elbow), hinge);
  poser.set(kLowerArm + side, bent * glm::angleAxis(radians(sign * -14.0f), glm::normalize(lower)));
  // Relaxed fingers close a little more than at rest.
  for (const int first : {kIndex1, kMiddle1, kRing1, kPinky1}) {
    const Vec3 palm = glm::normalize(glm::cross(lower, kZ)) * sign;
    const Vec3 knuckles = glm::normalize(glm::cross(glm::normalize(lower), palm));
    for (int bone = 0; bone < 3; ++bone) {
      const Quat hand = poser.turned(kLowerArm + side);
      const float curl = static_cast<float>(bone + 1) * (first == kIndex1 ? 7.0f : 10.0f);
      poser.set(first + side + bone, hand * glm::angleAxis(radians(curl), knuckles));
    }
  }
}

/// One foot of the walk at a phase of its own: 0 its heel's strike, 1 the next.
class FootPath {
 public:
  FootPath(const Figure& figure) : f_(figure), s_(figure.scale), step_(walkSpeed(figure) * kWalkSeconds) {}

  struct Place {
    Vec3 ankle{0.0f};    // of the left foot; x is its distance from the middle
    float pitch = 0.0f;  // degrees, positive lifts the heel
    float toe_pitch = 0.0f;
  };

  Place at(float phase) const {
    if (phase <= kToeOff) return stance(phase);
    const float u = (phase - kToeOff) / (1.0f - kToeOff);
    constexpr float kEps = 1e-3f;
    const Place off = stance(kToeOff), strike = stance(0.0f);
    Place place;
    const float span = 1.0f - kToeOff;
    const Vec3 off_speed = (off.ankle - stance(kToeOff - kEps).ankle) / kEps * span;
    const Vec3 strike_speed = (stance(kEps).ankle - strike.ankle) / kEps * span;
    place.ankle = hermite(off.ankle, off_speed, strike.ankle, strike_speed, u);
    // Up at once, so that the toes are clear of the ground before they swing forward.
    place.ankle.y += (11.0f * u * u + 2.4f * u) * (1.0f - u) * (1.0f - u) * kLift * s_;
    const float off_turn = (off.pitch - stance(kToeOff - kEps).pitch) / kEps * span;
    place.pitch = hermite(off.pitch, 0.55f * off_turn, strike.pitch, 0.0f, u);
    place.toe_pitch = std::lerp(off.toe_pitch, place.pitch, smoothStep(0.0f, 0.45f, u));
    return place;
  }

 private:
  static constexpr float kToeOff = 0.62f, kFlat = 0.11f, kHeelOff = 0.34f;
  static constexpr float kStrikePitch = -20.0f, kToeOffPitch = 50.0f;
  static constexpr float kLift = 0.050f;

  template <class T>
  static T hermite(const T& a, const T& slope_a, const T& b, const T& slope_b, float t) {
    const float t2 = t * t, t3 = t2 * t;
    return a * (2.0f * t3 - 3.0f * t2 + 1.0f) + slope_a * (t3 - 2.0f * t2 + t) + b * (3.0f * t2 - 2.0f * t3) +
           slope_b * (t3 - t2);
  }

  /// On the ground: rolls over the heel, stands flat, rolls over the ball of the foot.
  Place stance(float phase) const {
    const Vec3 rest = f_.joints[kFoot], ball = f_.joints[kBall];
    Place place;
    Vec3 pivot(0.0f);
    if (phase < kFlat) {
      const float t = 1.0f - phase / kFlat;
      place.pitch = kStrikePitch * t * t * (3.0f - 2.0f * t);
      pivot = Vec3(rest.x, 0.006f * s_, rest.z - 0.042f * s_);
    } else if (phase > kHeelOff) {
      const float t = (phase - kHeelOff) / (kToeOff - kHeelOff);
      place.pitch = kToeOffPitch * t * t * (1.0f + 0.35f * (1.0f - t));
      pivot = Vec3(rest.x, ball.y, ball.z);
    }
    if (phase < kFlat) place.toe_pitch = place.pitch;
    const Vec3 turned = pivot + turn(place.pitch, kX) * (Vec3(rest.x, rest.y, rest.z) - pivot);
    place.ankle = turned + Vec3(-0.22f * rest.x, 0.0f, step_ * (kMiddle - phase));
    return place;
  }

  static constexpr float kMiddle = 0.268f;  // the phase at which the foot stands as at rest

  const Figure& f_;
  float s_, step_;
};

float wrapped(float phase) { return phase - std::floor(phase); }

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

void placeFoot(Poser& poser, int side, const FootPath::Place& place) {
  const bool is_left = side == 0;
  Vec3 ankle = place.ankle;
  if (!is_left) ankle.x = -ankle.x;
  poser.placeAnkle(side, ankle);
  poser.set(kFoot + side, turn(place.pitch, kX));
  poser.set(kBall + side, turn(place.toe_pitch, kX));
}

/// Closes the loop and keeps neighbouring keys on the same side of the quaternion sphere.
Clip toClip(const char* name, float seconds, const std::vector<std::vector<Transform>>& keys) {
  Clip clip;
  clip.name = name;
  clip.seconds = seconds;
  clip.key_count = static_cast<std::uint32_t>(keys.size()) + 1;
  for (std::size_t k = 0; k <= keys.size(); ++k) {
    for (std::size_t b = 0; b < keys[0].size(); ++b) {
      Transform transform = k < keys.size() ? keys[k][b] : keys[0][b];
      if (k > 0 && k < keys.size()) {
        const Quat& before = clip.transforms[clip.transforms.size() - keys[0].size()].rotation;
        if (glm::dot(before, transform.rotation) < 0.0f) transform.rotation = -transform.rotation;
      }
      clip.transforms.push_back(transform);
    }
  }
  return clip;
}

}  // namespace

float walkSpeed(const Figure& figure) { return 1.22f * figure.joints[kThigh].y; }

Clip makeWalkClip(const Figure& figure, const RawSkeleton& skeleton) {
  const FootPath path(figure);
  const float s = figure.scale;
  constexpr std::uint32_t kSteps = kWalkKeys - 1;
  const auto phaseOf = [](std::uint32_t key) { return static_cast<float>(key) / static_cast<float>(kSteps); };
  const auto pelvisOffset = [&](float phase) {
    // Highest in the middle of each stance, over the standing leg.
    return Vec3(0.017f * s * wave(phase, 0.30f), -0.022f * s * wave(2.0f * phase, 0.14f),
                0.006f * s * wave(2.0f * phase, 0.0f));
  };
  // As high as the legs allow over the whole stride.
  float drop = 0.0f;
  for (std::uint32_t key = 0; key < kSteps; ++key) {
    Poser poser(figure, skeleton);
    poser.movePelvis(pelvisOffset(phaseOf(key)));
    poseWalkingTrunk(poser, phaseOf(key));
    for (const int side : {0, static_cast<int>(kRightLeg)}) {
      const float phase = wrapped(phaseOf(key) + (side == 0 ? 0.0f : 0.5f));
      if (phase > 0.55f && phase < 0.93f) continue;  // it hangs
      Vec3 ankle = path.at(phase).ankle;
      if (side != 0) ankle.x = -ankle.x;
      const Vec3 reach = poser.hip(side) - ankle;
      const float allowed = 0.9985f * poser.legReach();
      const float flat = reach.x * reach.x + reach.z * reach.z;
      drop = std::max(drop, reach.y - std::sqrt(std::max(allowed * allowed - flat, 0.0f)));
    }
  }
  std::vector<std::vector<Transform>> keys;
  for (std::uint32_t key = 0; key < kSteps; ++key) {
    const float phase = phaseOf(key);
    Poser poser(figure, skeleton);
    poser.movePelvis(pelvisOffset(phase) - Vec3(0.0f, drop, 0.0f));
    poseWalkingTrunk(poser, phase);
    placeFoot(poser, 0, path.at(phase));
    placeFoot(poser, kRightLeg, path.at(wrapped(phase + 0.5f)));
    keys.push_back(poser.local());
  }
  Clip clip = toClip("walk", kWalkSeconds, keys);
  clip.ground_speed = walkSpeed(figure);
  return clip;
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

}  // namespace ensemble
