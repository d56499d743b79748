// Somebody on a journey: where, looking where, in which pose, with feet that stay where they stand.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/gait.h"
#include "renderer/journey.h"

namespace ensemble {

/// How the people of one wardrobe walk and stand: a clip for each. At scale 1.
struct WalkStyle {
  std::uint32_t walk_clip = 0;             ///< index into TemplateBody::clips, as the next
  std::optional<std::uint32_t> idle_clip;  ///< without one, who stands keeps the pose of the last step
  float stride = 1.0f;                     ///< metres walked in one walk clip
  float idle_seconds = 0.0f;
  float idle_below = 0.4f;  ///< metres a second at scale 1: slower, the walk blends into standing
  /// Steps of the walk; without them feet are not held.
  std::optional<Gait> gait;
  std::vector<std::array<Vec3, 2>> walk_ankles, idle_ankles;  ///< #keys by 2, model space
};

/// Somebody's own way of doing a journey.
struct Walker {
  std::uint32_t journey = 0;     ///< index into Crowd::journeys
  std::uint32_t style = 0;       ///< index into Crowd::walk_styles
  double head_start = 0.0;       ///< seconds of the journey that are done at time 0
  float phase = 0.0f;            ///< of the walk where the journey begins, and of idling at time 0
  std::uint32_t first_foot = 0;  ///< on which foot it stands at the first stop: 0 left, 1 right
};

/// What holds a foot on the ground: its ankle is moved, its sole turned. Model space.
struct FootShift {
  float x = 0.0f, z = 0.0f;  ///< metres at scale 1
  float yaw = 0.0f;          ///< radians about +Y
};

/// Where feet stand takes most of the time, and matters for those alone who are drawn.
enum class FeetOf : std::uint8_t { kAll, kNobody };

struct WalkerPose {
  Vec3 position{0.0f};
  float heading = 0.0f;
  float speed = 0.0f;        ///< metres a second over the ground
  float walk_phase = 0.0f;   ///< 0 .. 1
  float idle_phase = 0.0f;   ///< 0 .. 1
  float idle_weight = 0.0f;  ///< 0 walks, 1 stands
  bool holds_feet = false;
  std::array<FootShift, 2> feet;  ///< FeetOf::kNobody: not moved
  bool exists = true;             ///< false: not there at this time
};

/// The walk's phase is distance over stride, so that a planted foot moves back as fast as the figure
/// moves on. What turns, changes of speed and blending leave of sliding is taken out foot by foot: a
/// foot stands on the print that it would make if the figure went on straight from where the other
/// foot passes it. Between two stands the stride is stretched so that both are reached on one foot.
/// A function of time alone. @param scale the figure's
WalkerPose walkAt(const Walker& walker, const Journey& journey, const WalkStyle& style, float scale,
                  double seconds, FeetOf feet = FeetOf::kAll);

}  // namespace ensemble
