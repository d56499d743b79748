// Arms, hands, legs and feet, all left ones.
#include <algorithm>
#include <cmath>

#include "assetpipe/people_builder.h"

namespace ensemble {

const std::array<FigureBuilder::Finger, 4> FigureBuilder::kFingers = {
    {{kIndex1, 0.094f, 0.0318f, 7.0f, 0.076f, 1.0f},
     {kMiddle1, 0.097f, 0.0106f, 2.0f, 0.084f, 1.03f},
     {kRing1, 0.094f, -0.0106f, -4.0f, 0.078f, 0.98f},
     {kPinky1, 0.086f, -0.0308f, -11.0f, 0.062f, 0.88f}}};

void FigureBuilder::placeArmJoints() {
  const Vec3 upper = glm::normalize(Vec3(std::sin(radians(35.0f)), -std::cos(radians(35.0f)), -0.03f));
  const Vec3 lower = glm::normalize(Vec3(std::sin(radians(31.0f)), -std::cos(radians(31.0f)), 0.16f));
  joint(kClavicle) = at(m_.clavicle);
  joint(kUpperArm) = at(m_.shoulder);
  joint(kLowerArm) = joint(kUpperArm) + s(m_.upper_arm) * upper;
  joint(kHand) = joint(kLowerArm) + s(m_.forearm) * lower;
  hand_frame_ = loftFrame(joint(kHand), joint(kHand) + lower, Vec3(0.0f, 0.0f, 1.0f));
  hand_size_ = m_.hand / 0.19f;
  figure_.hand_end = fromHand(0.19f, 0.0f, 0.02f);
  placeFingers();
  for (int i = 0; i < kRightArm; ++i) {
    joint(kClavicle + kRightArm + i) = Vec3(-1.0f, 1.0f, 1.0f) * joint(kClavicle + i);
  }
}

Vec3 FigureBuilder::fromHand(float along, float thumbward, float palmward) const {
  const Vec3 local = figure_.scale * hand_size_ * Vec3(palmward, along, thumbward);
  return hand_frame_.origin + hand_frame_.world_from_local * local;
}

/// Relaxed fingers: each phalanx bends a little more into the palm.
void FigureBuilder::placeFingers() {
  constexpr float kParts[3] = {0.44f, 0.30f, 0.26f};
  constexpr float kCurl[3] = {10.0f, 22.0f, 32.0f};
  for (std::size_t f = 0; f < 4; ++f) {
    const Finger& finger = kFingers[f];
    Vec3 place(finger.along, finger.thumbward, 0.001f);
    for (std::size_t i = 0; i < 3; ++i) {
      joint(finger.joint + static_cast<int>(i)) = fromHand(place.x, place.y, place.z);
      const float length = finger.length * kParts[i];
      const float curl = radians(kCurl[i]), splay = radians(finger.splay_degrees);
      place +=
          length * Vec3(std::cos(curl) * std::cos(splay), std::cos(curl) * std::sin(splay), std::sin(curl));
    }
    figure_.finger_ends[f] = fromHand(place.x, place.y, place.z);
  }
  joint(kThumb1) = fromHand(0.026f, 0.022f, 0.008f);
  joint(kThumb2) = fromHand(0.062f, 0.046f, 0.018f);
  joint(kThumb3) = fromHand(0.090f, 0.058f, 0.023f);
  figure_.finger_ends[4] = fromHand(0.114f, 0.063f, 0.028f);
}

void FigureBuilder::buildArm() {
  SolidGroup& arm = figure_.arm_solids;
  const Vec3 front(0.0f, 0.0f, 1.0f);
  const float l = m_.upper_arm / 0.295f, f = m_.forearm / 0.258f;
  const Vec3 axis = glm::normalize(joint(kLowerArm) - joint(kUpperArm));
  arm.join(loft(loftFrame(joint(kUpperArm), joint(kLowerArm), front),
                {{0.010f * l, 0, 0, 0.040f, 0.046f, 0.046f},
                 {0.080f * l, 0, 0, 0.047f, 0.051f, 0.050f},
                 {0.165f * l, 0, 0.002f, 0.0445f, 0.0495f, 0.0465f},
                 {0.245f * l, 0, 0, 0.0385f, 0.0405f, 0.0405f},
                 {0.295f * l, 0, 0, 0.0375f, 0.0385f, 0.0400f}},
                limb_),
           0.0f);
  // The muscle over the shoulder runs down the outside of the arm to a third of it.
  const Mat3 along = loftFrame(Vec3(0.0f), axis, front).world_from_local;
  const float round = limb_ * (0.6f + 0.4f * muscle_) * (female_ ? 0.95f : 1.0f);
  const Vec3 cap = joint(kUpperArm) + s(0.046f * l) * axis;
  arm.join(Solid::ellipsoid(cap, figure_.scale * Vec3(0.052f * round, 0.072f * l, 0.056f * round), along),
           s(0.03f));
  // Biceps and triceps.
  arm.join(Solid::ellipsoid(joint(kUpperArm) + s(0.170f * l) * axis + Vec3(0, 0, s(0.016f * limb_)),
                            figure_.scale * limb_ * Vec3(0.030f, 0.070f, 0.034f * muscle_), along),
           s(0.03f));
  arm.join(loft(loftFrame(joint(kLowerArm), joint(kHand), front),
                {{0.000f * f, 0, 0, 0.0365f, 0.0375f, 0.0385f},
                 {0.060f * f, 0, 0.002f, 0.0410f, 0.0430f, 0.0400f},
                 {0.150f * f, 0, 0, 0.0335f, 0.0360f, 0.0340f},
                 {0.220f * f, 0, 0, 0.0235f, 0.0295f, 0.0285f},
                 {0.258f * f, 0, 0, 0.0205f, 0.0280f, 0.0270f}},
                limb_),
           s(0.008f));
}

void FigureBuilder::buildHand() {
  SolidGroup& hand = figure_.hand_solids;
  std::vector<LoftRow> palm = {{-0.020f, 0, 0, 0.0195f, 0.0270f, 0.0260f},
                               {0.010f, 0, 0, 0.0190f, 0.0300f, 0.0280f},
                               {0.045f, 0, 0, 0.0165f, 0.0380f, 0.0365f},
                               {0.080f, 0, 0, 0.0135f, 0.0410f, 0.0385f},
                               {0.098f, 0, 0, 0.0108f, 0.0385f, 0.0360f}};
  for (LoftRow& row : palm) row.along *= hand_size_;
  const float thick = 0.5f * (hand_size_ + limb_);
  hand.join(loft(hand_frame_, palm, thick, 0.35f), 0.0f);
  // The heel of the hand and the ball of the thumb.
  const auto pad = [&](const Vec3& place, const Vec3& radii) {
    hand.join(Solid::ellipsoid(fromHand(place.x, place.y, place.z), figure_.scale * thick * radii,
                               hand_frame_.world_from_local),
              s(0.014f));
  };
  pad(Vec3(0.034f, -0.020f, 0.008f), Vec3(0.013f, 0.030f, 0.014f));
  const auto phalanx = [&](const Vec3& a, const Vec3& b, float ra, float rb, float blend) {
    hand.join(Solid::roundCone(a, b, s(ra * thick), s(rb * thick)), s(blend));
  };
  for (std::size_t f = 0; f < kFingers.size(); ++f) {
    const int first = kFingers[f].joint;
    const float slim = kFingers[f].slim;
    phalanx(joint(first), joint(first + 1), 0.0093f * slim, 0.0087f * slim, 0.005f);
    phalanx(joint(first + 1), joint(first + 2), 0.0087f * slim, 0.0082f * slim, 0.002f);
    phalanx(joint(first + 2), figure_.finger_ends[f], 0.0082f * slim, 0.0078f * slim, 0.002f);
  }
  phalanx(joint(kThumb1), joint(kThumb2), 0.0170f, 0.0125f, 0.016f);
  phalanx(joint(kThumb2), joint(kThumb3), 0.0120f, 0.0105f, 0.006f);
  phalanx(joint(kThumb3), figure_.finger_ends[4], 0.0105f, 0.0088f, 0.003f);
}

void FigureBuilder::buildLeg() {
  SolidGroup& leg = figure_.leg_solids;
  const Vec3 front(0.0f, 0.0f, 1.0f);
  const float t = glm::distance(m_.hip, m_.knee) / 0.425f, c = glm::distance(m_.knee, m_.ankle) / 0.417f;
  const float hip = female_ ? 1.135f : 1.0f;  // a woman's thighs are fuller for her other limbs
  const auto thigh = [&](float y, float x, float side, float fore, float back) {
    const float fuller = (1.0f + (hip - 1.0f) * (1.0f - 0.5f * y / 0.425f)) *
                         (1.0f + 0.05f * std::max(girth_, 0.0f) * (1.0f - y / 0.425f));
    return LoftRow{y * t, x, 0, side * fuller, fore * fuller, back * fuller};
  };
  leg.join(loft(loftFrame(joint(kThigh), joint(kCalf), front),
                {thigh(0.0f, 0, 0.086f, 0.090f, 0.088f), thigh(0.10f, 0, 0.084f, 0.091f, 0.087f),
                 thigh(0.22f, 0, 0.0745f, 0.0815f, 0.0755f), thigh(0.34f, 0, 0.0610f, 0.0650f, 0.0610f),
                 thigh(0.425f, 0, 0.0520f, 0.0540f, 0.0530f)},
                limb_),
           0.0f);
  // The calf swells behind, a little more to the inside, and tapers late.
  const float in = -0.003f * limb_;
  leg.join(loft(loftFrame(joint(kCalf), joint(kFoot), front),
                {{0.000f * c, 0, 0, 0.0505f, 0.0520f, 0.0520f},
                 {0.055f * c, 0, 0, 0.0500f, 0.0475f, 0.0570f},
                 {0.120f * c, in, 0, 0.0540f, 0.0435f, 0.0680f},
                 {0.190f * c, in, 0, 0.0515f, 0.0415f, 0.0620f},
                 {0.265f * c, 0, 0, 0.0410f, 0.0385f, 0.0455f},
                 {0.335f * c, 0, 0, 0.0335f, 0.0365f, 0.0375f},
                 {0.400f * c, 0, 0, 0.0315f, 0.0365f, 0.0390f}},
                limb_ * (female_ ? 1.06f : 1.0f)),
           s(0.008f));
  leg.join(ball(m_.knee + Vec3(0, 0.004f, 0.036f * limb_), Vec3(0.026f, 0.036f, 0.019f) * limb_), s(0.022f));
}

void FigureBuilder::buildFoot() {
  SolidGroup& foot = figure_.foot_solids;
  const float size = m_.ball.z / 0.105f;
  const float wide = 0.5f * (size + limb_);
  const LoftFrame frame = loftFrame(at(Vec3(m_.ankle.x, 0, 0)),
                                    at(Vec3(m_.ankle.x, 0, 0)) + Vec3(0.10f, 0, 1), Vec3(0.0f, 1.0f, 0.0f));
  std::vector<LoftRow> rows = {
      {-0.055f, 0, 0.034f, 0.029f, 0.040f, 0.044f},      {-0.018f, 0, 0.042f, 0.0315f, 0.050f, 0.052f},
      {0.040f, 0, 0.036f, 0.0345f, 0.040f, 0.044f},      {0.095f, 0.002f, 0.023f, 0.0430f, 0.026f, 0.034f},
      {0.128f, 0.002f, 0.016f, 0.0435f, 0.015f, 0.024f}, {0.146f, 0.002f, 0.013f, 0.0380f, 0.011f, 0.018f}};
  for (LoftRow& row : rows) {
    row.along *= size;
    row.center_z *= size;
  }
  foot.join(loft(frame, rows, wide, 0.18f), 0.0f);
  foot.join(cone(m_.ankle + Vec3(0, 0.03f, 0.003f), m_.ankle + Vec3(0, -0.02f, 0.006f), 0.034f * limb_,
                 0.036f * limb_),
            s(0.012f));
  for (const float side : {1.0f, -1.0f}) {
    foot.join(
        ball(m_.ankle + Vec3(side * 0.030f * limb_, side * -0.006f, 0.004f), Vec3(0.010f, 0.014f, 0.013f)),
        s(0.015f));
  }
  buildToes(frame, size, wide);
}

/// The big one inside, set off a little from the others, which lie close together.
void FigureBuilder::buildToes(const LoftFrame& frame, float size, float wide) {
  for (int toe = 0; toe < 5; ++toe) {
    const auto number = static_cast<float>(toe);
    const float x = toe == 0 ? -0.0285f : -0.0225f + 0.0146f * number;
    const float tip = (0.178f - 0.0030f * number * number) * size;
    const float radius = toe == 0 ? 0.0140f : 0.0105f - 0.0003f * number;
    const auto place = [&](float along, float up) {
      return frame.origin + frame.world_from_local * (figure_.scale * Vec3(-x * wide, along, up));
    };
    figure_.foot_solids.join(Solid::roundCone(place(tip - 0.050f, 0.016f),
                                              place(tip - radius, radius * 0.90f), s(radius), s(radius)),
                             s(toe == 0 ? 0.006f : 0.008f));
  }
}

}  // namespace ensemble
