// What is worn on trunk and limbs: the skin offset outwards, joined with what hangs.
#include <algorithm>
#include <cmath>

#include "assetpipe/cloth_design.h"

namespace ensemble {
namespace {

constexpr float kClearance = 0.003f;  // metres that cloth keeps off the smoothed skin

class BodyCloth {
 public:
  BodyCloth(const TailorFrame& frame, const GarmentRecipe& recipe)
      : frame_(frame), recipe_(recipe), s_(frame.scale()) {}

  ClothDesign design() const {
    ClothDesign design;
    design.shell = shell();
    addHem(design);
    addTop(design);
    addSleeves(design);
    if (recipe_.front) addFront(design);
    fitBox(design);
    design.cell = 0.0065f * s_;
    return design;
  }

 private:
  /// Shares of a point's zones blend where they meet, so that a sleeve may be wider than the trunk's cloth.
  float easeAt(const Vec3& p) const {
    const AuthorBody& body = frame_.body();
    const auto to = [&](BodyZone a, BodyZone b) {
      return std::min(body.distanceTo(a, p), body.distanceTo(b, p));
    };
    const float trunk = to(BodyZone::kTorso, BodyZone::kHead), arms = to(BodyZone::kArms, BodyZone::kHands),
                legs = to(BodyZone::kLegs, BodyZone::kFeet);
    const float nearest = std::min({trunk, arms, legs}), soft = 0.014f * s_;
    const auto share = [&](float distance) { return std::exp((nearest - distance) / soft); };
    const float level = frame_.levelOf(p.y);
    const float of_trunk = share(trunk), of_arms = share(arms), of_legs = share(legs);
    return s_ *
           (of_trunk * recipe_.ease.at(level) + of_arms * recipe_.sleeve_ease.at(frame_.armPlace(p)) +
            of_legs * recipe_.leg_ease.at(level)) /
           (of_trunk + of_arms + of_legs);
  }

  Field shell() const {
    Field hanging;
    if (recipe_.drape) {
      HangOptions options;
      const DrapeRecipe& drape = *recipe_.drape;
      options.top = frame_.heightOf(drape.from);
      options.bottom = frame_.heightOf(recipe_.hem) - (0.04f + std::abs(recipe_.hem_rise)) * s_;
      options.ease = drape.ease * s_;
      options.cling = drape.cling;
      options.flare = drape.flare;
      options.folds = drape.folds * s_;
      options.fold_count = drape.fold_count;
      hanging = hangingCloth(frame_, options);
    }
    return [this_ = *this, hanging, solids = joinedSolids(frame_, recipe_.solids)](const Vec3& p) {
      const float skin = this_.frame_.body().distance(p);
      float value = skin - this_.easeAt(p);
      if (hanging) value = smoothMin(value, hanging(p), 0.03f * this_.s_);
      value = smoothMin(value, solids(p), 0.012f * this_.s_);
      return std::min(value, skin - kClearance * this_.s_);
    };
  }

  void addHem(ClothDesign& design) const {
    const float height = frame_.heightOf(recipe_.hem), rise = recipe_.hem_rise * s_;
    const Vec3 hip = frame_.marks().at(Landmark::kHip);
    design.edges.push_back({"hem", [&frame = frame_, height, rise, hip, s = s_](const Vec3& p) {
                              const float front = smoothStep(-0.12f * s, 0.12f * s, p.z - hip.z);
                              return std::min(height + rise * (front - 0.5f) - p.y, frame.offArms(p));
                            }});
  }

  void addTop(ClothDesign& design) const {
    if (recipe_.top) {
      design.edges.push_back(
          {"top", [height = frame_.heightOf(*recipe_.top)](const Vec3& p) { return p.y - height; }});
      return;
    }
    const NeckRecipe& neck = *recipe_.neck;
    const Vec3 base = frame_.marks().at(Landmark::kNeck), head = frame_.marks().at(Landmark::kHead);
    const Vec3 axis = glm::normalize(glm::normalize(head - base) + Vec3(0.0f, 1.0f, 0.0f));
    const Field solids = joinedSolids(frame_, recipe_.solids);
    design.edges.push_back(
        {"neck", [neck, base, axis, solids, s = s_](const Vec3& p) {
           const Vec3 from = p - base;
           const float up = glm::dot(from, axis);
           const float wide = neck.width * s - glm::length(from - axis * up);
           const float rise = up - neck.rise * s;
           // The shoulders may stand higher than the neck's edge, but not by much; what does is chin.
           const float chin =
               std::min(up - (std::max(neck.rise, 0.0f) + 0.025f) * s, 0.14f * s - std::abs(from.x));
           float value = std::max(std::min(rise, wide), chin);
           if (neck.drop > 0.0f) {
             const Vec3 radii = s * Vec3(neck.width + 0.010f, neck.drop, 0.125f);
             const Vec3 scoop = (from - Vec3(0.0f, 0.010f, 0.055f) * s) / radii;
             value = std::max(value, (1.0f - glm::length(scoop)) * std::min(radii.x, radii.y));
           }
           if (neck.vee > 0.0f) {
             const float slope = neck.width / neck.vee;
             const float deep = slope * (from.y + neck.vee * s) - std::abs(from.x);
             value = std::max(value, std::min(deep / std::sqrt(1.0f + slope * slope), p.z - base.z));
           }
           return std::min(value, solids(p) - 0.004f * s);
         }});
  }

  void addSleeves(ClothDesign& design) const {
    if (recipe_.sleeves) {
      design.edges.push_back({"sleeves", [&frame = frame_, end = recipe_.sleeves->to, s = s_](const Vec3& p) {
                                return std::min(frame.beyondArmPlace(p, end), -frame.offArms(p) + 0.01f * s);
                              }});
      return;
    }
    const float armhole = recipe_.armhole.value_or(0.0f) * s_;
    design.edges.push_back(
        {"sleeves", [&frame = frame_, armhole](const Vec3& p) { return armhole - frame.offArms(p); }});
  }

  void addFront(ClothDesign& design) const {
    const FrontRecipe& front = *recipe_.front;
    const float low = frame_.heightOf(front.level.from), high = frame_.heightOf(front.level.to);
    const Vec3 hip = 0.5f * (frame_.marks().at(Landmark::kHip, 0) + frame_.marks().at(Landmark::kHip, 1));
    design.edges.push_back(
        {"front", [front, low, high, hip, s = s_](const Vec3& p) {
           const float share = std::clamp((p.y - low) / (high - low), 0.0f, 1.0f);
           const float half = s * glm::mix(front.width.from, front.width.to, share);
           return std::min({half - std::abs(p.x - hip.x), p.z - hip.z, p.y - low, high - p.y});
         }});
  }

  void fitBox(ClothDesign& design) const {
    const AuthorBody& body = frame_.body();
    const float room = 0.30f * s_;
    design.low = body.low() - room;
    design.high = body.high() + 0.05f * s_;
    design.high.x = body.high().x + room;
    design.high.z = body.high().z + room;
    design.low.y = frame_.heightOf(recipe_.hem) - (0.05f + std::abs(recipe_.hem_rise)) * s_;
    // Sleeves may reach below the hem.
    if (recipe_.sleeves) {
      const Vec3 wrist = frame_.marks().at(Landmark::kWrist), elbow = frame_.marks().at(Landmark::kElbow);
      design.low.y = std::min(design.low.y, (recipe_.sleeves->to > 1.0f ? wrist : elbow).y - 0.16f * s_);
    }
    if (recipe_.top) design.high.y = frame_.heightOf(*recipe_.top) + 0.03f * s_;
  }

  const TailorFrame& frame_;
  const GarmentRecipe& recipe_;
  float s_;
};

}  // namespace

ClothDesign designBodyCloth(const TailorFrame& frame, const GarmentRecipe& recipe) {
  return BodyCloth(frame, recipe).design();
}

}  // namespace ensemble
