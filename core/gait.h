// Legs and steps: which joints are the legs, and when a walking clip sets which foot on the ground.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/clip.h"
#include "core/math.h"
#include "core/raw_asset.h"

namespace ensemble {

/// A leg as inverse kinematics sees it. Positions are those of the bind pose, model space.
struct Leg {
  std::uint32_t hip = 0, knee = 0, ankle = 0;  ///< joints
  Vec3 hip_position{0.0f}, knee_position{0.0f}, ankle_position{0.0f};
};

struct Legs {
  std::array<Leg, 2> legs;  ///< the left one (+X) first
  /// Per joint: 0, or 1 + part + 3 * leg (shaders/shared/leg_ik.h).
  std::vector<std::uint32_t> groups;
};

/// Finds a figure's two legs by shape, whatever its joints are called: two chains side by side that
/// part below the pelvis and come down to the ankles, the knee half way. None where there are not
/// just two (a quadruped, a skirt's joints that can't be told from legs).
std::optional<Legs> findLegs(const RawSkeleton& skeleton);

/// When a foot stands, in parts of the clip. begin <= middle <= end, end - begin < 1, 0 <= middle < 1.
struct Contact {
  float begin = 0.0f, middle = 0.0f, end = 0.0f;  ///< middle: the other foot passes it
};

/// The steps of a clip that walks in place.
struct Gait {
  float stride = 0.0f;  ///< metres the figure walks in one clip, at scale 1
  std::array<Contact, 2> contacts;
};

/// The contacts of both feet of a clip that walks towards +Z, from where its feet are low and move
/// backwards as fast as the ground does (within a third). None where the clip has no ground speed,
/// or a foot never stands.
std::optional<Gait> analyzeGait(const RawSkeleton& skeleton, const Legs& legs, const Clip& clip);

/// Both ankles at every key of a clip, #keys by 2, model space.
std::vector<std::array<Vec3, 2>> anklePaths(const RawSkeleton& skeleton, const Legs& legs, const Clip& clip);

}  // namespace ensemble
