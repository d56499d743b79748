#include "assetpipe/ground_speed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "assetpipe/root_motion.h"

namespace ensemble {
namespace {

constexpr float kFootHeight = 0.03f;  // metres: joints that come this near to the lowest one are of the feet
constexpr float kContactRise = 0.005f;   // metres above a foot joint's own lowest place: it stands
constexpr float kStandingSpeed = 0.05f;  // metres a second
constexpr float kSkatingShare = 0.25f;   // of the travelled speed: feet differ by more
constexpr float kAheadDegrees = 30.0f;   // a direction that still counts as +Z

float median(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Positions of the joints' bones, per key.
std::vector<std::vector<Vec3>> jointPaths(const RawSkeleton& skeleton, const Clip& clip) {
  std::vector<std::vector<Vec3>> paths;
  std::vector<Mat4> world_from_bone(skeleton.bones.size());
  for (std::uint32_t key = 0; key < clip.key_count; ++key) {
    globalPose(skeleton, clip.key(key), world_from_bone);
    std::vector<Vec3>& positions = paths.emplace_back();
    for (const RawJoint& joint : skeleton.joints) positions.emplace_back(world_from_bone[joint.bone][3]);
  }
  return paths;
}

/// Each joint's lowest height over the clip, or the lowest float where it is no foot.
std::vector<float> footHeights(const std::vector<std::vector<Vec3>>& paths) {
  constexpr float kNoFoot = std::numeric_limits<float>::lowest();
  std::vector<float> lowest(paths.front().size(), std::numeric_limits<float>::max());
  for (const auto& positions : paths) {
    for (std::size_t j = 0; j < lowest.size(); ++j) lowest[j] = std::min(lowest[j], positions[j].y);
  }
  // A root on the ground is no foot: it does not leave it.
  std::vector<bool> moves(lowest.size(), false);
  for (const auto& positions : paths) {
    for (std::size_t j = 0; j < lowest.size(); ++j) moves[j] = moves[j] || positions[j] != paths.front()[j];
  }
  float ground = std::numeric_limits<float>::max();
  for (std::size_t j = 0; j < lowest.size(); ++j) {
    if (moves[j]) ground = std::min(ground, lowest[j]);
  }
  for (std::size_t j = 0; j < lowest.size(); ++j) {
    if (!moves[j] || lowest[j] > ground + kFootHeight) lowest[j] = kNoFoot;
  }
  return lowest;
}

}  // namespace

float groundSpeed(const RawSkeleton& skeleton, const Clip& clip) {
  if (clip.key_count < 2 || !(clip.seconds > 0.0f) || skeleton.joints.empty()) return 0.0f;
  const std::vector<std::vector<Vec3>> paths = jointPaths(skeleton, clip);
  const std::vector<float> lowest = footHeights(paths);
  std::vector<float> along_x, along_z;
  for (std::size_t key = 0; key + 1 < paths.size(); ++key) {
    for (std::size_t j = 0; j < lowest.size(); ++j) {
      const Vec3& before = paths[key][j];
      const Vec3& after = paths[key + 1][j];
      if (std::max(before.y, after.y) > lowest[j] + kContactRise) continue;
      along_x.push_back(after.x - before.x);
      along_z.push_back(after.z - before.z);
    }
  }
  if (along_x.empty()) return 0.0f;
  const float interval_seconds = clip.seconds / static_cast<float>(clip.key_count - 1);
  const float speed = glm::length(Vec2(median(along_x), median(along_z))) / interval_seconds;
  return speed < kStandingSpeed ? 0.0f : speed;
}

void putInPlace(const RawSkeleton& skeleton, Clip& clip, std::vector<std::string>& warnings) {
  const Vec2 velocity = takeOutRootMotion(skeleton, clip);
  const float feet_speed = groundSpeed(skeleton, clip);
  clip.ground_speed = glm::length(velocity);
  if (clip.ground_speed < kStandingSpeed) {
    clip.ground_speed = feet_speed;
    return;
  }
  const float heading_degrees = degrees(std::atan2(velocity.x, velocity.y));
  if (std::abs(heading_degrees) > kAheadDegrees) {
    warnings.push_back(fmt::format(
        "clip '{}' travels at {:.0f} degrees to the direction that the figure faces; it keeps its heading, "
        "and slides sideways where people follow a path",
        clip.name, heading_degrees));
  }
  if (std::abs(feet_speed - clip.ground_speed) > kSkatingShare * clip.ground_speed) {
    warnings.push_back(fmt::format(
        "clip '{}' travels at {:.2f} m/s, but its feet stand on a ground that moves at {:.2f} m/s; feet "
        "will slide",
        clip.name, clip.ground_speed, feet_speed));
  }
}

}  // namespace ensemble
