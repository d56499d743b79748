#include "assetpipe/people_poser.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace ensemble {
namespace {

/// The frame of a limb: y along it, z as near to the pole as can be.
Mat3 limbFrame(const Vec3& along, const Vec3& pole) {
  const Vec3 y = glm::normalize(along);
  const Vec3 x = glm::normalize(glm::cross(y, pole));
  return Mat3(x, y, glm::cross(x, y));
}

template <class T>
T hermite(const T& a, const T& slope_a, const T& b, const T& slope_b, float t) {
  const float t2 = t * t, t3 = t2 * t;
  return a * (2.0f * t3 - 3.0f * t2 + 1.0f) + slope_a * (t3 - 2.0f * t2 + t) + b * (3.0f * t2 - 2.0f * t3) +
         slope_b * (t3 - t2);
}

}  // namespace

Poser::Poser(const Figure& figure, const RawSkeleton& skeleton)
    : f_(figure), skeleton_(skeleton), pelvis_(restJoint(kPelvis)) {}

void Poser::set(int index, const Quat& from_rest) {
  turned_[static_cast<std::size_t>(index)] = from_rest;
  is_set_[static_cast<std::size_t>(index)] = true;
}

Quat Poser::turned(int index) const {
  return is_set_[static_cast<std::size_t>(index)] ? turned_[static_cast<std::size_t>(index)]
                                                  : inherited(index);
}

void Poser::placeAnkle(int side, const Vec3& ankle) {
  const int thigh = kThigh + side, calf = kCalf + side, foot = kFoot + side;
  const Vec3 upper = restJoint(calf) - restJoint(thigh), lower = restJoint(foot) - restJoint(calf);
  const float a = glm::length(upper), b = glm::length(lower);
  const Vec3 reach = ankle - hip(side);
  const float d = std::min(glm::length(reach), 0.9995f * (a + b));
  const Vec3 way = glm::normalize(reach);
  const Vec3 front = turned(kPelvis) * kZ + Vec3(side == 0 ? 0.10f : -0.10f, 0.0f, 0.0f);
  const Vec3 pole = glm::normalize(front - way * glm::dot(front, way));
  const float cosine = std::clamp((a * a + d * d - b * b) / (2.0f * a * d), -1.0f, 1.0f);
  const Vec3 knee = a * (cosine * way + std::sqrt(1.0f - cosine * cosine) * pole);
  set(thigh, glm::quat_cast(limbFrame(knee, pole) * glm::transpose(limbFrame(upper, kZ))));
  set(calf, glm::quat_cast(limbFrame(d * way - knee, pole) * glm::transpose(limbFrame(lower, kZ))));
}

float Poser::legReach() const {
  return glm::distance(restJoint(kThigh), restJoint(kCalf)) +
         glm::distance(restJoint(kCalf), restJoint(kFoot));
}

Vec3 Poser::hip(int side) const {
  return pelvis_ + turned(kPelvis) * (restJoint(kThigh + side) - restJoint(kPelvis));
}

std::vector<Transform> Poser::local() const {
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

Quat Poser::inherited(int index) const {
  const std::int32_t parent = jointParent(static_cast<std::uint16_t>(index));
  return parent < 0 ? Quat(1, 0, 0, 0) : turned(parent);
}

Quat Poser::restWorld(int index) const {
  Quat world = skeleton_.bones[static_cast<std::size_t>(index)].rest.rotation;
  for (std::int32_t p = jointParent(static_cast<std::uint16_t>(index)); p >= 0;
       p = jointParent(static_cast<std::uint16_t>(p))) {
    world = skeleton_.bones[static_cast<std::size_t>(p)].rest.rotation * world;
  }
  return world;
}

void poseArm(Poser& poser, int side, const ArmAngles& angles) {
  const float sign = side == 0 ? 1.0f : -1.0f;
  const Vec3 upper = poser.restJoint(kLowerArm + side) - poser.restJoint(kUpperArm + side);
  const Vec3 lower = poser.restJoint(kHand + side) - poser.restJoint(kLowerArm + side);
  const float rest_outward = degrees(std::atan2(std::abs(upper.x), -upper.y));
  const Quat down = turn(sign * (angles.outward - rest_outward), kZ);
  const Quat swing = turn(-angles.forward, kX);
  const Quat raised = poser.turned(kSpine3) * swing * down;
  poser.set(kUpperArm + side, raised);
  // The elbow closes towards the front; then the forearm turns the palm.
  const Vec3 hinge = glm::normalize(glm::cross(upper, kZ));
  const Quat bent = raised * glm::angleAxis(radians(angles.elbow), hinge);
  poser.set(kLowerArm + side, bent * glm::angleAxis(radians(sign * angles.twist), glm::normalize(lower)));
  // Relaxed fingers close a little more than at rest.
  for (const int first : {kIndex1, kMiddle1, kRing1, kPinky1}) {
    const Vec3 palm = glm::normalize(glm::cross(lower, kZ)) * sign;
    const Vec3 knuckles = glm::normalize(glm::cross(glm::normalize(lower), palm));
    for (int bone = 0; bone < 3; ++bone) {
      const Quat hand = poser.turned(kLowerArm + side);
      const float curl = angles.curl * static_cast<float>(bone + 1) * (first == kIndex1 ? 7.0f : 10.0f);
      poser.set(first + side + bone, hand * glm::angleAxis(radians(curl), knuckles));
    }
  }
}

FootPlace FootPath::at(float phase) const {
  const Gait& g = gait_;
  if (phase <= g.toe_off) return stance(phase);
  const float u = (phase - g.toe_off) / (1.0f - g.toe_off);
  constexpr float kEps = 1e-3f;
  const FootPlace off = stance(g.toe_off), strike = stance(0.0f);
  FootPlace place;
  const float span = 1.0f - g.toe_off;
  const Vec3 off_speed = (off.ankle - stance(g.toe_off - kEps).ankle) / kEps * span;
  const Vec3 strike_speed = (stance(kEps).ankle - strike.ankle) / kEps * span;
  place.ankle = hermite(off.ankle, off_speed, strike.ankle, strike_speed, u);
  // Up at once, so that the toes are clear of the ground before they swing forward.
  place.ankle.y += (11.0f * u * u + g.early_lift * u) * (1.0f - u) * (1.0f - u) * g.lift * s_;
  const float off_turn = (off.pitch - stance(g.toe_off - kEps).pitch) / kEps * span;
  place.pitch = hermite(off.pitch, 0.55f * off_turn, strike.pitch, 0.0f, u) +
                g.swing_pitch * 6.75f * u * (1.0f - u) * (1.0f - u);
  place.toe_pitch = std::lerp(off.toe_pitch, place.pitch, smoothStep(0.0f, 0.45f, u));
  return place;
}

/// On the ground: rolls over the heel, stands flat, rolls over the ball of the foot.
FootPlace FootPath::stance(float phase) const {
  const Gait& g = gait_;
  const Vec3 rest = f_.joints[kFoot], ball = f_.joints[kBall];
  FootPlace place;
  Vec3 pivot(0.0f);
  if (phase < g.flat) {
    const float t = 1.0f - phase / g.flat;
    place.pitch = g.strike_pitch * t * t * (3.0f - 2.0f * t);
    pivot = Vec3(rest.x, 0.006f * s_, rest.z - 0.042f * s_);
  } else if (phase > g.heel_off) {
    const float t = (phase - g.heel_off) / (g.toe_off - g.heel_off);
    place.pitch = g.toe_off_pitch * t * t * (1.0f + 0.35f * (1.0f - t));
    pivot = Vec3(rest.x, ball.y, ball.z);
  }
  if (phase < g.flat) place.toe_pitch = place.pitch;
  const Vec3 turned = pivot + turn(place.pitch, kX) * (Vec3(rest.x, rest.y, rest.z) - pivot);
  place.ankle = turned + Vec3(-g.narrow * rest.x, 0.0f, step_ * (g.middle - phase));
  return place;
}

void placeFoot(Poser& poser, int side, const FootPlace& place) {
  const bool is_left = side == 0;
  Vec3 ankle = place.ankle;
  if (!is_left) ankle.x = -ankle.x;
  poser.placeAnkle(side, ankle);
  poser.set(kFoot + side, turn(place.pitch, kX));
  poser.set(kBall + side, turn(place.toe_pitch, kX));
}

Clip toClip(const std::string& name, float seconds, const std::vector<std::vector<Transform>>& keys) {
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

namespace {

/// How far the pelvis must go down for standing feet to be reached, metres: the most over the clip.
float pelvisDrop(const Figure& figure, const RawSkeleton& skeleton, const FootPath& path, const Gait& gait,
                 std::uint32_t steps, const PoseTrunk& pose) {
  float drop = 0.0f;
  for (std::uint32_t key = 0; key < steps; ++key) {
    const float now = static_cast<float>(key) / static_cast<float>(steps);
    Poser poser(figure, skeleton);
    pose(poser, now);
    for (const int side : {0, static_cast<int>(kRightLeg)}) {
      const float phase = wrapped(now + (side == 0 ? 0.0f : 0.5f));
      if (phase > gait.toe_off - 0.07f && phase < 0.93f) continue;  // it hangs
      Vec3 ankle = path.at(phase).ankle;
      if (side != 0) ankle.x = -ankle.x;
      const Vec3 reach = poser.hip(side) - ankle;
      const float allowed = 0.9985f * poser.legReach();
      const float flat = reach.x * reach.x + reach.z * reach.z;
      drop = std::max(drop, reach.y - std::sqrt(std::max(allowed * allowed - flat, 0.0f)));
    }
  }
  return drop;
}

}  // namespace

Clip makeStrideClip(const std::string& name, const Figure& figure, const RawSkeleton& skeleton,
                    const Gait& gait, std::uint32_t keys, const PoseTrunk& pose) {
  const std::uint32_t steps = keys - 1;
  const FootPath path(figure, gait);
  const float drop = pelvisDrop(figure, skeleton, path, gait, steps, pose);
  std::vector<std::vector<Transform>> poses;
  for (std::uint32_t key = 0; key < steps; ++key) {
    const float phase = static_cast<float>(key) / static_cast<float>(steps);
    Poser poser(figure, skeleton);
    pose(poser, phase);
    poser.lowerPelvis(drop);
    placeFoot(poser, 0, path.at(phase));
    placeFoot(poser, kRightLeg, path.at(wrapped(phase + 0.5f)));
    poses.push_back(poser.local());
  }
  Clip clip = toClip(name, gait.seconds, poses);
  clip.ground_speed = gait.speed;
  return clip;
}

}  // namespace ensemble
