#include "core/gait.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shaders/shared/leg_ik.h"

namespace ensemble {
namespace {

constexpr float kAnkleHeight = 0.16f;    // of the figure's height: an ankle is below, its knee above
constexpr float kHipHeight = 0.35f;      // of the figure's height: a leg comes from above this
constexpr float kPlantedRise = 0.015f;   // metres above a foot joint's own lowest place: it may stand
constexpr float kPlantedMisfit = 0.34f;  // of the ground speed
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

Vec3 bindPosition(const RawJoint& joint) { return Vec3(glm::inverse(joint.joint_from_model)[3]); }

/// The joints as a tree of their own: bones that are no joints are passed over.
class JointTree {
 public:
  explicit JointTree(const RawSkeleton& skeleton) : parents_(skeleton.joints.size(), kNone) {
    std::vector<std::uint32_t> joint_of_bone(skeleton.bones.size(), kNone);
    for (std::uint32_t j = 0; j < skeleton.joints.size(); ++j) joint_of_bone[skeleton.joints[j].bone] = j;
    for (std::uint32_t j = 0; j < skeleton.joints.size(); ++j) {
      positions_.push_back(bindPosition(skeleton.joints[j]));
      top_ = std::max(top_, positions_.back().y);
      std::int32_t bone = skeleton.bones[skeleton.joints[j].bone].parent;
      while (bone >= 0 && joint_of_bone[static_cast<std::size_t>(bone)] == kNone) {
        bone = skeleton.bones[static_cast<std::size_t>(bone)].parent;
      }
      if (bone >= 0) parents_[j] = joint_of_bone[static_cast<std::size_t>(bone)];
    }
  }

  std::uint32_t parent(std::uint32_t joint) const { return parents_[joint]; }
  const Vec3& position(std::uint32_t joint) const { return positions_[joint]; }
  float top() const { return top_; }
  /// Whether `joint` is `above` or hangs on it.
  bool hangsOn(std::uint32_t joint, std::uint32_t above) const {
    while (joint != kNone && joint != above) joint = parents_[joint];
    return joint == above;
  }
  /// From a joint up to its root.
  std::vector<std::uint32_t> chain(std::uint32_t joint) const {
    std::vector<std::uint32_t> up;
    for (; joint != kNone; joint = parents_[joint]) up.push_back(joint);
    return up;
  }

 private:
  std::vector<std::uint32_t> parents_;
  std::vector<Vec3> positions_;
  float top_ = 0.0f;
};

/// Joints at ankle height whose parent is above it, and who hang on something as high as a hip.
std::vector<std::uint32_t> findAnkles(const JointTree& tree, std::size_t joint_count) {
  std::vector<std::uint32_t> ankles;
  const float ankle_height = kAnkleHeight * tree.top();
  for (std::uint32_t j = 0; j < joint_count; ++j) {
    const std::uint32_t parent = tree.parent(j);
    if (parent == kNone || tree.position(j).y > ankle_height || tree.position(parent).y <= ankle_height)
      continue;
    const std::vector<std::uint32_t> up = tree.chain(parent);
    const bool comes_from_hip = std::any_of(
        up.begin(), up.end(), [&](std::uint32_t a) { return tree.position(a).y > kHipHeight * tree.top(); });
    if (comes_from_hip) ankles.push_back(j);
  }
  return ankles;
}

/// The leg that ends in `ankle`: its hip is the last joint that the other ankle does not hang on.
std::optional<Leg> makeLeg(const JointTree& tree, std::uint32_t ankle, std::uint32_t other) {
  Leg leg;
  leg.ankle = ankle;
  leg.hip = ankle;
  std::vector<std::uint32_t> between;
  for (std::uint32_t j = tree.parent(ankle); j != kNone && !tree.hangsOn(other, j); j = tree.parent(j)) {
    between.push_back(j);
    leg.hip = j;
  }
  if (between.size() < 2) return std::nullopt;
  between.pop_back();
  const float half_way = 0.5f * (tree.position(leg.hip).y + tree.position(ankle).y);
  const auto off = [&](std::uint32_t j) { return std::abs(tree.position(j).y - half_way); };
  leg.knee = *std::min_element(between.begin(), between.end(),
                               [&](std::uint32_t a, std::uint32_t b) { return off(a) < off(b); });
  leg.hip_position = tree.position(leg.hip);
  leg.knee_position = tree.position(leg.knee);
  leg.ankle_position = tree.position(ankle);
  return leg;
}

/// A foot at one key of a clip, model space.
struct FootKey {
  Vec3 ankle{0.0f};
  std::vector<Vec3> joints;  ///< of the foot
};

std::vector<FootKey> footKeys(const RawSkeleton& skeleton, const Legs& legs, std::uint32_t leg,
                              const Clip& clip) {
  std::vector<FootKey> keys(clip.key_count);
  std::vector<Mat4> world_from_bone(skeleton.bones.size());
  for (std::uint32_t key = 0; key < clip.key_count; ++key) {
    globalPose(skeleton, clip.key(key), world_from_bone);
    for (std::uint32_t j = 0; j < skeleton.joints.size(); ++j) {
      if (legs.groups[j] != 1u + ENSEMBLE_LEG_FOOT + ENSEMBLE_LEG_PARTS * leg) continue;
      keys[key].joints.emplace_back(world_from_bone[skeleton.joints[j].bone][3]);
    }
    keys[key].ankle = Vec3(world_from_bone[skeleton.joints[legs.legs[leg].ankle].bone][3]);
  }
  return keys;
}

/// Per interval between keys: whether some joint of the foot stands on a ground that moves.
std::vector<bool> findPlanted(const std::vector<FootKey>& keys, float ground_step) {
  const std::size_t joints = keys.front().joints.size();
  std::vector<float> lowest(joints, std::numeric_limits<float>::max());
  for (const FootKey& key : keys) {
    for (std::size_t j = 0; j < joints; ++j) lowest[j] = std::min(lowest[j], key.joints[j].y);
  }
  std::vector<bool> planted(keys.size() - 1, false);
  for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
    for (std::size_t j = 0; j < joints; ++j) {
      const Vec3 &from = keys[i].joints[j], &to = keys[i + 1].joints[j];
      const Vec2 misfit(to.x - from.x, to.z - from.z + ground_step);
      if (std::max(from.y, to.y) > lowest[j] + kPlantedRise) continue;
      if (glm::length(misfit) < kPlantedMisfit * ground_step) planted[i] = true;
    }
  }
  return planted;
}

/// The longest run of true in a loop: first interval and how many; none where there is no true, or
/// nothing else.
std::optional<std::pair<std::size_t, std::size_t>> longestRun(const std::vector<bool>& flags) {
  const std::size_t count = flags.size();
  std::pair<std::size_t, std::size_t> best{0, 0};
  for (std::size_t first = 0; first < count; ++first) {
    if (!flags[first] || flags[(first + count - 1) % count]) continue;
    std::size_t length = 0;
    while (length < count && flags[(first + length) % count]) ++length;
    if (length > best.second) best = {first, length};
  }
  if (best.second == 0) return std::nullopt;
  return best;
}

}  // namespace

std::optional<Legs> findLegs(const RawSkeleton& skeleton) {
  if (skeleton.joints.empty()) return std::nullopt;
  const JointTree tree(skeleton);
  const std::vector<std::uint32_t> ankles = findAnkles(tree, skeleton.joints.size());
  if (ankles.size() != 2) return std::nullopt;
  const bool first_is_left = tree.position(ankles[0]).x > tree.position(ankles[1]).x;
  const std::uint32_t left = ankles[first_is_left ? 0 : 1], right = ankles[first_is_left ? 1 : 0];
  if (tree.hangsOn(left, right) || tree.hangsOn(right, left)) return std::nullopt;
  const std::optional<Leg> left_leg = makeLeg(tree, left, right), right_leg = makeLeg(tree, right, left);
  if (!left_leg || !right_leg) return std::nullopt;
  Legs legs{{*left_leg, *right_leg}, std::vector<std::uint32_t>(skeleton.joints.size(), 0)};
  for (std::uint32_t j = 0; j < skeleton.joints.size(); ++j) {
    for (std::uint32_t l = 0; l < 2; ++l) {
      const Leg& leg = legs.legs[l];
      if (!tree.hangsOn(j, leg.hip)) continue;
      const std::uint32_t part = tree.hangsOn(j, leg.ankle)  ? ENSEMBLE_LEG_FOOT
                                 : tree.hangsOn(j, leg.knee) ? ENSEMBLE_LEG_SHIN
                                                             : ENSEMBLE_LEG_THIGH;
      legs.groups[j] = 1u + part + ENSEMBLE_LEG_PARTS * l;
    }
  }
  return legs;
}

std::vector<std::array<Vec3, 2>> anklePaths(const RawSkeleton& skeleton, const Legs& legs, const Clip& clip) {
  std::vector<std::array<Vec3, 2>> ankles;
  std::vector<Mat4> world_from_bone(skeleton.bones.size());
  for (std::uint32_t key = 0; key < clip.key_count; ++key) {
    globalPose(skeleton, clip.key(key), world_from_bone);
    ankles.push_back({Vec3(world_from_bone[skeleton.joints[legs.legs[0].ankle].bone][3]),
                      Vec3(world_from_bone[skeleton.joints[legs.legs[1].ankle].bone][3])});
  }
  return ankles;
}

std::optional<Gait> analyzeGait(const RawSkeleton& skeleton, const Legs& legs, const Clip& clip) {
  if (clip.key_count < 4 || !(clip.ground_speed > 0.0f) || !(clip.seconds > 0.0f)) return std::nullopt;
  Gait gait;
  gait.stride = clip.ground_speed * clip.seconds;
  const auto intervals = static_cast<float>(clip.key_count - 1);
  const std::array<std::vector<FootKey>, 2> feet{footKeys(skeleton, legs, 0, clip),
                                                 footKeys(skeleton, legs, 1, clip)};
  for (std::size_t f = 0; f < 2; ++f) {
    const auto run = longestRun(findPlanted(feet[f], gait.stride / intervals));
    if (!run) return std::nullopt;
    // The feet pass where their ankles are side by side.
    float nearest = std::numeric_limits<float>::max();
    std::size_t middle = run->first;
    for (std::size_t i = run->first; i <= run->first + run->second; ++i) {
      const std::size_t key = i % (clip.key_count - 1);
      const float apart = std::abs(feet[f][key].ankle.z - feet[1 - f][key].ankle.z);
      if (apart < nearest) {
        nearest = apart;
        middle = i;
      }
    }
    Contact& contact = gait.contacts[f];
    contact = {static_cast<float>(run->first) / intervals, static_cast<float>(middle) / intervals,
               static_cast<float>(run->first + run->second) / intervals};
    const float turns = std::floor(contact.middle);
    contact.begin -= turns;
    contact.middle -= turns;
    contact.end -= turns;
  }
  return gait;
}

}  // namespace ensemble
