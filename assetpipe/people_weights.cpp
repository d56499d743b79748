// Skin weights as a function of position. A point first belongs to limbs, by how much nearer it is to
// one than to the others; along a limb it passes from bone to bone in smooth steps at the joints.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "assetpipe/people_body.h"
#include "core/check.h"

namespace ensemble {
namespace {

using Weights = std::array<float, kBodyJointCount>;

/// The four largest, renormalised.
SkinBinding toBinding(const Weights& weights) {
  std::array<std::uint16_t, kBodyJointCount> order;
  std::iota(order.begin(), order.end(), std::uint16_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint16_t a, std::uint16_t b) { return weights[a] > weights[b]; });
  SkinBinding skin;
  float sum = 0.0f;
  for (std::size_t i = 0; i < 4; ++i) sum += std::max(weights[order[i]] - weights[order[4]], 0.0f);
  ENSEMBLE_CHECK(sum > 0.0f);
  for (std::size_t i = 0; i < 4; ++i) {
    // The fifth is subtracted so that a joint fades out before another takes its place.
    const float weight = std::max(weights[order[i]] - weights[order[4]], 0.0f) / sum;
    if (weight < 1e-3f) continue;
    skin.joints[i] = order[i];
    skin.weights[i] = weight;
  }
  const float kept = skin.weights[0] + skin.weights[1] + skin.weights[2] + skin.weights[3];
  for (float& weight : skin.weights) weight /= kept;
  return skin;
}

/// Weighs one point. `left` is its mirror image on the left side.
class Weigher {
 public:
  Weigher(const Figure& figure, const Vec3& p)
      : f_(figure),
        p_(p),
        left_(std::abs(p.x), p.y, p.z),
        s_(figure.scale),
        arm_offset_(p.x < 0.0f ? kRightArm : 0) {}

  Weights run() {
    const float arm = std::min(f_.arm(left_), f_.hand(left_));
    const float torso = f_.torso(left_), head = f_.head(left_);
    const float leg = std::min(f_.leg_solids.distance(left_), f_.foot(left_));
    const float nearest = std::min({arm, torso, head, leg});
    const auto share = [&](float distance, float width) {
      const float t = std::max(0.0f, 1.0f - (distance - nearest) / (width * s_));
      return t * t;
    };
    const float to_torso = share(torso, 0.060f), to_head = share(head, 0.045f);
    const float to_arm = share(arm, 0.055f), to_leg = share(leg, 0.070f) * legReach();
    const float sum = to_torso + to_head + to_arm + to_leg;
    weighTorso(to_torso / sum);
    weighHead(to_head / sum);
    weighArm(to_arm / sum);
    const float left_side = leftSide();
    weighLeg(to_leg / sum * (p_.x >= 0.0f ? left_side : 1.0f - left_side), 0);
    weighLeg(to_leg / sum * (p_.x >= 0.0f ? 1.0f - left_side : left_side), kRightLeg);
    return weights_;
  }

 private:
  const Vec3& joint(int index) const { return f_.joints[static_cast<std::size_t>(index)]; }
  void add(int index, float weight) { weights_[static_cast<std::size_t>(index)] += weight; }

  /// The leg does not pull the belly and the small of the back along.
  float legReach() const { return 1.0f - smoothStep(0.01f * s_, 0.11f * s_, p_.y - joint(kThigh).y); }

  /// How much a point on its own side follows its own leg: all of it below the groin.
  float leftSide() const {
    const float groin = joint(kThigh).y - 0.09f * s_;
    const float width = glm::mix(0.006f, 0.035f, smoothStep(-0.05f * s_, 0.06f * s_, p_.y - groin)) * s_;
    return smoothStep(-width, width, left_.x);
  }

  void weighTorso(float share) {
    const float half = 0.055f * s_;
    const auto above = [&](int index) {
      return smoothStep(joint(index).y - half, joint(index).y + half, p_.y);
    };
    const float first = above(kSpine1), second = first * above(kSpine2), third = second * above(kSpine3);
    const float shoulder = 0.85f * smoothStep(0.03f * s_, 0.14f * s_, left_.x) *
                           smoothStep(-0.13f * s_, -0.01f * s_, p_.y - joint(kUpperArm).y);
    add(kPelvis, share * (1.0f - first));
    add(kSpine1, share * (first - second));
    add(kSpine2, share * (second - third));
    add(kSpine3, share * third * (1.0f - shoulder));
    add(kClavicle + arm_offset_, share * third * shoulder);
  }

  void weighHead(float share) {
    const float neck = smoothStep(-0.030f * s_, 0.055f * s_, neckline(f_, p_, 0.0f, 1.0f));
    const float up = p_.y - joint(kHead).y + 0.5f * p_.z;
    const float head = smoothStep(-0.045f * s_, 0.015f * s_, up);
    add(kSpine3, share * (1.0f - neck));
    add(kNeck, share * neck * (1.0f - head));
    add(kHead, share * neck * head);
  }

  void weighArm(float share) {
    if (share <= 0.0f) return;
    const Vec3 upper = glm::normalize(joint(kLowerArm) - joint(kUpperArm));
    const Vec3 lower = glm::normalize(joint(kHand) - joint(kLowerArm));
    const float half = 0.038f * s_;
    const float elbow =
        smoothStep(-half, half, glm::dot(left_ - joint(kLowerArm), glm::normalize(upper + lower)));
    const float wrist = smoothStep(-0.020f * s_, 0.020f * s_, glm::dot(left_ - joint(kHand), lower));
    add(kUpperArm + arm_offset_, share * (1.0f - elbow));
    add(kLowerArm + arm_offset_, share * elbow * (1.0f - wrist));
    weighHand(share * elbow * wrist);
  }

  struct Grip {
    float nearness = 0.0f;  // 0 away from the finger, 1 on it
    float along = 0.0f;     // bones passed, 0 .. 3
  };

  /// How much a point belongs to the finger that starts at `first`, and how far along it is.
  Grip grip(int first) const {
    const bool is_thumb = first == kThumb1;
    Grip grip;
    float best = 1e9f;
    for (int bone = 0; bone < 3; ++bone) {
      const Vec3 a = joint(first + bone);
      const Vec3 b = bone < 2 ? joint(first + bone + 1) : a + (a - joint(first + 1)) * 0.9f;
      const float t = glm::dot(left_ - a, b - a) / glm::dot(b - a, b - a);
      best = std::min(best, glm::distance(left_, glm::mix(a, b, std::clamp(t, 0.0f, 1.0f))));
      const float half = (bone == 0 ? (is_thumb ? 0.018f : 0.010f) : 0.006f) * s_;
      const Vec3 before = bone == 0 ? a - joint(kHand) : a - joint(first + bone - 1);
      const Vec3 axis = glm::normalize(glm::normalize(before) + glm::normalize(b - a));
      grip.along +=
          smoothStep(-half, half, glm::dot(left_ - a, axis) - (bone == 0 && is_thumb ? half : 0.0f));
    }
    const float radius = (is_thumb ? 0.016f : 0.0105f) * s_;
    grip.nearness = 1.0f - smoothStep(radius, radius * 1.7f, best);
    return grip;
  }

  void weighHand(float share) {
    if (share <= 0.0f) return;
    constexpr std::array<int, 5> kFirst = {kIndex1, kMiddle1, kPinky1, kRing1, kThumb1};
    std::array<Grip, 5> grips;
    float sum = 0.0f;
    for (std::size_t i = 0; i < grips.size(); ++i) {
      grips[i] = grip(kFirst[i]);
      grips[i].nearness *= std::min(grips[i].along, 1.0f);
      sum += grips[i].nearness;
    }
    const float scale = share / std::max(sum, 1.0f);
    for (std::size_t i = 0; i < grips.size(); ++i) {
      const float own = scale * grips[i].nearness;
      for (int bone = 0; bone < 3; ++bone) {
        const float over = static_cast<float>(bone);
        const float from = bone == 0 ? 1.0f : std::clamp(grips[i].along - over, 0.0f, 1.0f);
        const float to = bone == 2 ? 0.0f : std::clamp(grips[i].along - over - 1.0f, 0.0f, 1.0f);
        add(kFirst[i] + arm_offset_ + bone, own * (from - to));
      }
    }
    add(kHand + arm_offset_, share - scale * sum);
  }

  void weighLeg(float share, int offset) {
    if (share <= 0.0f) return;
    const Vec3 upper = glm::normalize(joint(kCalf) - joint(kThigh));
    const Vec3 lower = glm::normalize(joint(kFoot) - joint(kCalf));
    const float half = 0.055f * s_;
    const float knee = smoothStep(-half, half, glm::dot(left_ - joint(kCalf), glm::normalize(upper + lower)));
    const float ankle =
        smoothStep(-0.035f * s_, 0.030f * s_, joint(kFoot).y - p_.y + 0.25f * (p_.z - joint(kFoot).z));
    const float ball = smoothStep(-0.022f * s_, 0.022f * s_, p_.z - joint(kBall).z);
    // At the very top the pelvis holds the leg's end inside the hip.
    const float hip = smoothStep(-0.02f * s_, 0.10f * s_, joint(kThigh).y - p_.y);
    add(kPelvis, share * (1.0f - hip) * 0.6f);
    const float thigh = 1.0f - (1.0f - hip) * 0.6f;
    add(kThigh + offset, share * thigh * (1.0f - knee));
    add(kCalf + offset, share * thigh * knee * (1.0f - ankle));
    add(kFoot + offset, share * thigh * knee * ankle * (1.0f - ball));
    add(kBall + offset, share * thigh * knee * ankle * ball);
  }

  const Figure& f_;
  const Vec3 p_, left_;
  const float s_;
  const int arm_offset_;
  Weights weights_{};
};

}  // namespace

SkinBinding bodyBinding(const Figure& figure, const Vec3& p) { return toBinding(Weigher(figure, p).run()); }

}  // namespace ensemble
