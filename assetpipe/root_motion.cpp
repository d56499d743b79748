#include "assetpipe/root_motion.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace ensemble {
namespace {

constexpr float kNoTravel = 1e-4f;      // metres: the noise of exporters
constexpr float kTravelsAlong = 0.01f;  // metres, and as a share of the travel
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

std::size_t parentOf(const RawSkeleton& skeleton, std::size_t bone) {
  const std::int32_t parent = skeleton.bones[bone].parent;
  return parent < 0 ? kNone : static_cast<std::size_t>(parent);
}

std::vector<Mat4> globalPoseAt(const RawSkeleton& skeleton, const Clip& clip, std::uint32_t key) {
  std::vector<Mat4> world_from_bone(skeleton.bones.size());
  globalPose(skeleton, clip.key(key), world_from_bone);
  return world_from_bone;
}

/// How many joints each bone carries, its own included.
std::vector<std::size_t> carriedJoints(const RawSkeleton& skeleton) {
  std::vector<std::size_t> carried(skeleton.bones.size(), 0);
  for (const RawJoint& joint : skeleton.joints) {
    for (std::size_t bone = joint.bone; bone != kNone; bone = parentOf(skeleton, bone)) ++carried[bone];
  }
  return carried;
}

/// The lowest joint that ends a chain: a foot, or toes. It hangs on three joints at least (hips, thigh,
/// calf), which a root on the ground and most targets of inverse kinematics do not; if none does, any end.
std::size_t findFoot(const RawSkeleton& skeleton, const std::vector<Mat4>& pose) {
  std::vector<bool> is_end(skeleton.bones.size(), true), is_joint(skeleton.bones.size(), false);
  std::vector<std::size_t> joints_above(skeleton.bones.size(), 0);
  for (const RawJoint& joint : skeleton.joints) is_joint[joint.bone] = true;
  for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {  // parents come first
    const std::size_t parent = parentOf(skeleton, b);
    if (parent == kNone) continue;
    is_end[parent] = false;
    joints_above[b] = joints_above[parent] + (is_joint[parent] ? 1 : 0);
  }
  for (const std::size_t enough : {std::size_t{3}, std::size_t{0}}) {
    std::size_t foot = kNone;
    for (const RawJoint& joint : skeleton.joints) {
      if (!is_end[joint.bone] || joints_above[joint.bone] < enough) continue;
      if (foot == kNone || pose[joint.bone][3].y < pose[foot][3].y) foot = joint.bone;
    }
    if (foot != kNone) return foot;
  }
  return kNone;
}

/// The bones from the figure's hips up to a root. The hips are what carries a foot and at least half
/// of all joints: a spine carries no foot, a leg not half of the joints.
std::vector<std::size_t> hipsAndAbove(const RawSkeleton& skeleton, const std::vector<Mat4>& pose) {
  const std::size_t foot = findFoot(skeleton, pose);
  const std::vector<std::size_t> carried = carriedJoints(skeleton);
  std::vector<std::size_t> chain;
  for (std::size_t bone = foot; bone != kNone; bone = parentOf(skeleton, bone)) {
    if (2 * carried[bone] >= skeleton.joints.size()) chain.push_back(bone);
  }
  return chain;
}

Vec2 travelOf(std::size_t bone, const std::vector<Mat4>& first, const std::vector<Mat4>& last) {
  const Vec4 travel = last[bone][3] - first[bone][3];
  return {travel.x, travel.z};
}

/// The bones to move: the highest that carries at least half of the travel, and others that travel
/// along with none of them above.
std::vector<bool> findCarriers(const RawSkeleton& skeleton, const std::vector<Mat4>& first,
                               const std::vector<Mat4>& last, const std::vector<std::size_t>& chain) {
  const Vec2 travel = travelOf(chain.front(), first, last);
  std::vector<bool> is_carrier(skeleton.bones.size(), false), is_moved(skeleton.bones.size(), false);
  for (auto bone = chain.rbegin(); bone != chain.rend(); ++bone) {
    if (glm::dot(travelOf(*bone, first, last), travel) < 0.5f * glm::dot(travel, travel)) continue;
    is_carrier[*bone] = true;
    break;
  }
  std::vector<bool> is_above(skeleton.bones.size(), false);
  for (const std::size_t bone : chain) is_above[bone] = true;
  const float tolerance = kTravelsAlong * (1.0f + glm::length(travel));
  for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {  // parents come first
    const std::size_t parent = parentOf(skeleton, b);
    is_moved[b] = is_carrier[b] || (parent != kNone && is_moved[parent]);
    if (is_moved[b] || is_above[b]) continue;
    is_carrier[b] = is_moved[b] = glm::distance(travelOf(b, first, last), travel) <= tolerance;
  }
  return is_carrier;
}

}  // namespace

Vec2 takeOutRootMotion(const RawSkeleton& skeleton, Clip& clip) {
  if (clip.key_count < 2 || !(clip.seconds > 0.0f) || skeleton.joints.empty()) return Vec2(0.0f);
  const std::vector<Mat4> first = globalPoseAt(skeleton, clip, 0);
  const std::vector<Mat4> last = globalPoseAt(skeleton, clip, clip.key_count - 1);
  const std::vector<std::size_t> chain = hipsAndAbove(skeleton, first);
  if (chain.empty()) return Vec2(0.0f);
  const Vec2 travel = travelOf(chain.front(), first, last);
  if (!(glm::length(travel) >= kNoTravel)) return Vec2(0.0f);

  const std::vector<bool> is_carrier = findCarriers(skeleton, first, last, chain);
  for (std::uint32_t key = 1; key < clip.key_count; ++key) {
    const float share = static_cast<float>(key) / static_cast<float>(clip.key_count - 1);
    const Vec3 back(-share * travel.x, 0.0f, -share * travel.y);
    const std::vector<Mat4> world_from_bone = globalPoseAt(skeleton, clip, key);
    for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
      if (!is_carrier[b]) continue;
      // The parent's frame may be turned and scaled (centimetres under a node that scales by 0.01).
      const std::size_t parent = parentOf(skeleton, b);
      const Vec3 back_in_parent = parent == kNone ? back : glm::inverse(Mat3(world_from_bone[parent])) * back;
      clip.transforms[key * skeleton.bones.size() + b].translation += back_in_parent;
    }
  }
  return travel / clip.seconds;
}

}  // namespace ensemble
