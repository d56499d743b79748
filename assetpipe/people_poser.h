// What the clips are made of: a pose is told by how far each bone is turned from rest, in model space; what
// is not told follows its parent. For the sources people_clips, people_run and people_gestures only.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "assetpipe/people_figure.h"
#include "core/clip.h"

namespace ensemble {

inline Quat turn(float angle_degrees, const Vec3& axis) {
  return glm::angleAxis(radians(angle_degrees), axis);
}
inline const Vec3 kX(1.0f, 0.0f, 0.0f), kY(0.0f, 1.0f, 0.0f), kZ(0.0f, 0.0f, 1.0f);

/// A wave of period 1 that is 1 at `peak`.
inline float wave(float phase, float peak = 0.0f) { return std::cos(2.0f * kPi * (phase - peak)); }
inline float wrapped(float phase) { return phase - std::floor(phase); }

class Poser {
 public:
  Poser(const Figure& figure, const RawSkeleton& skeleton);

  const Vec3& restJoint(int index) const { return f_.joints[static_cast<std::size_t>(index)]; }
  void movePelvis(const Vec3& offset) { pelvis_ = restJoint(kPelvis) + offset; }
  void lowerPelvis(float drop) { pelvis_.y -= drop; }

  /// Turns a bone from rest, in model space, whatever its parent does. Parents first.
  void set(int index, const Quat& from_rest);
  Quat turned(int index) const;

  /// Bends a leg so that the ankle comes to `ankle` (or as near as it reaches), knee to the front: two
  /// bones, closed form.
  void placeAnkle(int side, const Vec3& ankle);
  float legReach() const;
  Vec3 hip(int side) const;

  /// Local transforms of every bone.
  std::vector<Transform> local() const;

 private:
  Quat inherited(int index) const;
  Quat restWorld(int index) const;

  const Figure& f_;
  const RawSkeleton& skeleton_;
  Vec3 pelvis_;
  std::array<Quat, kBodyJointCount> turned_{};
  std::array<bool, kBodyJointCount> is_set_{};
};

/// Degrees: from vertical outwards, forwards, the elbow's bend, the forearm's turn (positive: palm up and
/// out); and how far the fingers close, 1 = relaxed.
struct ArmAngles {
  float outward = 10.0f, forward = 0.0f, elbow = 15.0f, twist = -14.0f, curl = 1.0f;
};

/// An arm let down from the A-pose, with the chest as it is turned. @param side 0 or kRightArm
void poseArm(Poser& poser, int side, const ArmAngles& angles);

/// Closes the loop and keeps neighbouring keys on the same side of the quaternion sphere.
Clip toClip(const std::string& name, float seconds, const std::vector<std::vector<Transform>>& keys);

/// How a gait's feet move; phases are parts of the clip, 0 at the foot's strike.
struct Gait {
  float seconds = 1.1f, speed = 1.0f;                     ///< metres a second
  float toe_off = 0.62f, flat = 0.11f, heel_off = 0.34f;  ///< phases
  float strike_pitch = -20.0f, toe_off_pitch = 50.0f;     ///< degrees, positive lifts the heel
  float swing_pitch = 0.0f;                               ///< degrees more in mid-swing
  float lift = 0.050f;                                    ///< of the swinging foot, metres
  float early_lift = 2.4f;                                ///< how fast it leaves the ground
  float middle = 0.268f;                                  ///< the phase at which the foot stands as at rest
  float narrow = 0.22f;                                   ///< how much nearer to the middle it steps
};

/// Where a foot is.
struct FootPlace {
  Vec3 ankle{0.0f};    ///< of the left foot; x is its distance from the middle
  float pitch = 0.0f;  ///< degrees, positive lifts the heel
  float toe_pitch = 0.0f;
};

/// One foot of a gait. While it stands it moves backwards exactly as the ground does.
class FootPath {
 public:
  FootPath(const Figure& figure, const Gait& gait)
      : f_(figure), gait_(gait), s_(figure.scale), step_(gait.speed * gait.seconds) {}
  FootPlace at(float phase) const;

 private:
  FootPlace stance(float phase) const;

  const Figure& f_;
  Gait gait_;
  float s_, step_;
};

/// @param side 0 or kRightLeg
void placeFoot(Poser& poser, int side, const FootPlace& place);

/// Poses everything above the legs at a phase.
using PoseTrunk = std::function<void(Poser&, float phase)>;

/// A clip of one stride, in which both feet go as the gait tells, the right one half a stride after the left
/// one, and the pelvis is as high as the legs allow over all of it.
Clip makeStrideClip(const std::string& name, const Figure& figure, const RawSkeleton& skeleton,
                    const Gait& gait, std::uint32_t keys, const PoseTrunk& pose);

}  // namespace ensemble
