// Proportions follow the usual anthropometric tables (segment lengths as parts of the height, breadths
// and girths of adults); the shapes are ours, tuned by eye.
#include "assetpipe/people_figure.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/check.h"

namespace ensemble {
namespace {

/// Lengths of the reference figures in metres.
struct Measures {
  float height;
  float pelvis, spine1, spine2, spine3, neck, head;  // heights of the joints
  Vec3 clavicle, shoulder, hip, knee, ankle, ball;
  float upper_arm, forearm, hand;
  float limb;       // factor on the thickness of arms and legs
  float head_size;  // factor on the head
};

constexpr Measures kMan = {1.76f,
                           0.965f,
                           1.06f,
                           1.17f,
                           1.29f,
                           1.497f,
                           1.588f,
                           {0.025f, 1.45f, 0.0f},
                           {0.186f, 1.437f, -0.02f},
                           {0.092f, 0.925f, 0.0f},
                           {0.102f, 0.50f, 0.012f},
                           {0.108f, 0.085f, -0.027f},
                           {0.120f, 0.022f, 0.105f},
                           0.295f,
                           0.258f,
                           0.19f,
                           1.0f,
                           1.0f};
constexpr Measures kWoman = {1.66f,
                             0.915f,
                             1.00f,
                             1.10f,
                             1.21f,
                             1.412f,
                             1.497f,
                             {0.02f, 1.367f, 0.0f},
                             {0.156f, 1.354f, -0.018f},
                             {0.088f, 0.868f, 0.0f},
                             {0.094f, 0.468f, 0.012f},
                             {0.098f, 0.079f, -0.024f},
                             {0.108f, 0.021f, 0.095f},
                             0.274f,
                             0.238f,
                             0.174f,
                             0.86f,
                             0.955f};

/// Builds the solids in reference metres and scales them on the way in.
class Builder {
 public:
  explicit Builder(const FigureOptions& options)
      : m_(options.sex == Sex::kMale ? kMan : kWoman), female_(options.sex == Sex::kFemale) {
    figure_.options = options;
    figure_.scale = options.height / m_.height;
    trunk_ = 1.0f + (options.build > 0.0f ? 0.16f : 0.08f) * options.build;
    limb_ = m_.limb * (1.0f + 0.09f * options.build);
    figure_.trunk = trunk_;
    figure_.limb = limb_;
    figure_.head_center = s(fromHead(0.0f, 0.0f, 0.0f));
    figure_.head_size = figure_.scale * m_.head_size;
  }

  Figure run() {
    placeJoints();
    buildTorso();
    buildHead();
    buildFace();
    buildArm();
    buildHand();
    buildLeg();
    buildFoot();
    return std::move(figure_);
  }

 private:
  float s(float length) const { return length * figure_.scale; }
  Vec3 s(const Vec3& point) const { return point * figure_.scale; }
  Vec3& joint(int index) { return figure_.joints[static_cast<std::size_t>(index)]; }

  Solid cone(const Vec3& a, const Vec3& b, float radius_a, float radius_b) const {
    return Solid::roundCone(s(a), s(b), s(radius_a), s(radius_b));
  }
  Solid ball(const Vec3& center, const Vec3& radii, const Mat3& turn = Mat3(1.0f)) const {
    return Solid::ellipsoid(s(center), s(radii), turn);
  }
  /// Rows in reference metres; thickness multiplied by `thick`.
  Solid loft(const LoftFrame& frame, std::vector<LoftRow> rows, float thick, float boxiness = 0.0f) const {
    for (LoftRow& row : rows) {
      row.along = s(row.along);
      row.center_x = s(row.center_x);
      row.center_z = s(row.center_z);
      row.side = s(row.side * thick);
      row.front = s(row.front * thick);
      row.back = s(row.back * thick);
    }
    return Solid::loft(frame, std::move(rows), boxiness);
  }

  void placeJoints() {
    joint(kRoot) = Vec3(0.0f);
    joint(kPelvis) = s(Vec3(0.0f, m_.pelvis, 0.0f));
    joint(kSpine1) = s(Vec3(0.0f, m_.spine1, -0.005f));
    joint(kSpine2) = s(Vec3(0.0f, m_.spine2, -0.010f));
    joint(kSpine3) = s(Vec3(0.0f, m_.spine3, -0.018f));
    joint(kNeck) = s(Vec3(0.0f, m_.neck, -0.030f));
    joint(kHead) = s(Vec3(0.0f, m_.head, -0.008f));
    figure_.head_top = s(Vec3(0.0f, m_.height, 0.0f));
    const Vec3 upper = glm::normalize(Vec3(std::sin(radians(35.0f)), -std::cos(radians(35.0f)), -0.03f));
    const Vec3 lower = glm::normalize(Vec3(std::sin(radians(31.0f)), -std::cos(radians(31.0f)), 0.16f));
    joint(kClavicle) = s(m_.clavicle);
    joint(kUpperArm) = s(m_.shoulder);
    joint(kLowerArm) = s(m_.shoulder + upper * m_.upper_arm);
    joint(kHand) = s(m_.shoulder + upper * m_.upper_arm + lower * m_.forearm);
    hand_frame_ = loftFrame(joint(kHand), joint(kHand) + lower, Vec3(0.0f, 0.0f, 1.0f));
    hand_size_ = m_.hand / 0.19f;
    figure_.hand_end = fromHand(0.19f, 0.0f, 0.02f);
    placeFingers();
    joint(kThigh) = s(m_.hip);
    joint(kCalf) = s(m_.knee);
    joint(kFoot) = s(m_.ankle);
    joint(kBall) = s(m_.ball);
    figure_.toe_end = s(m_.ball + Vec3(0.006f, -0.008f, 0.075f));
    for (int i = 0; i < kRightArm; ++i) {
      joint(kClavicle + kRightArm + i) = Vec3(-1.0f, 1.0f, 1.0f) * joint(kClavicle + i);
    }
    for (int i = 0; i < kRightLeg; ++i) {
      joint(kThigh + kRightLeg + i) = Vec3(-1.0f, 1.0f, 1.0f) * joint(kThigh + i);
    }
  }

  /// A point of the left hand of reference size: along the hand, towards the thumb, out of the palm.
  Vec3 fromHand(float along, float thumbward, float palmward) const {
    const Vec3 local = s(Vec3(palmward, along, thumbward) * hand_size_);
    return hand_frame_.origin + hand_frame_.world_from_local * local;
  }

  struct Finger {
    int joint;
    float along, thumbward, splay_degrees, length;
  };
  static constexpr Finger kFingers[4] = {{kIndex1, 0.094f, 0.0300f, 5.0f, 0.078f},
                                         {kMiddle1, 0.097f, 0.0100f, 1.0f, 0.087f},
                                         {kRing1, 0.094f, -0.0100f, -4.0f, 0.080f},
                                         {kPinky1, 0.086f, -0.0290f, -9.0f, 0.064f}};

  /// Relaxed fingers: each phalanx bends a little more into the palm.
  void placeFingers() {
    constexpr float kParts[3] = {0.44f, 0.30f, 0.26f};
    constexpr float kCurl[3] = {10.0f, 22.0f, 32.0f};
    for (std::size_t f = 0; f < 4; ++f) {
      const Finger& finger = kFingers[f];
      Vec3 at(finger.along, finger.thumbward, 0.001f);
      for (std::size_t i = 0; i < 3; ++i) {
        joint(finger.joint + static_cast<int>(i)) = fromHand(at.x, at.y, at.z);
        const float length = finger.length * kParts[i];
        const float curl = radians(kCurl[i]), splay = radians(finger.splay_degrees);
        at +=
            length * Vec3(std::cos(curl) * std::cos(splay), std::cos(curl) * std::sin(splay), std::sin(curl));
      }
      finger_ends_[f] = fromHand(at.x, at.y, at.z);
    }
    joint(kThumb1) = fromHand(0.026f, 0.022f, 0.008f);
    joint(kThumb2) = fromHand(0.062f, 0.046f, 0.018f);
    joint(kThumb3) = fromHand(0.090f, 0.058f, 0.023f);
    thumb_end_ = fromHand(0.114f, 0.063f, 0.028f);
  }

  void buildTorso() {
    const LoftFrame frame{Vec3(0.0f), Mat3(1.0f)};
    const float belly = 1.0f + 0.12f * std::max(figure_.options.build, 0.0f);
    std::vector<LoftRow> rows;
    if (female_) {
      rows = {{0.880f, 0, 0.000f, 0.164f, 0.094f, 0.098f},  {0.930f, 0, 0.000f, 0.163f, 0.097f, 0.098f},
              {0.985f, 0, 0.000f, 0.146f, 0.095f, 0.086f},  {1.040f, 0, 0.000f, 0.126f, 0.089f, 0.077f},
              {1.095f, 0, 0.000f, 0.121f, 0.088f, 0.077f},  {1.160f, 0, -0.004f, 0.129f, 0.092f, 0.086f},
              {1.230f, 0, -0.010f, 0.136f, 0.094f, 0.093f}, {1.295f, 0, -0.015f, 0.137f, 0.083f, 0.095f},
              {1.345f, 0, -0.020f, 0.124f, 0.062f, 0.083f}, {1.385f, 0, -0.026f, 0.090f, 0.044f, 0.062f}};
    } else {
      rows = {{0.930f, 0, 0.003f, 0.160f, 0.098f, 0.104f},  {0.990f, 0, 0.002f, 0.160f, 0.102f, 0.102f},
              {1.060f, 0, 0.000f, 0.151f, 0.105f, 0.090f},  {1.130f, 0, 0.000f, 0.147f, 0.104f, 0.087f},
              {1.220f, 0, -0.004f, 0.155f, 0.108f, 0.100f}, {1.310f, 0, -0.008f, 0.168f, 0.116f, 0.112f},
              {1.380f, 0, -0.014f, 0.172f, 0.104f, 0.113f}, {1.440f, 0, -0.022f, 0.155f, 0.074f, 0.094f},
              {1.478f, 0, -0.028f, 0.112f, 0.052f, 0.070f}};
    }
    for (std::size_t i = 0; i < 5; ++i) rows[i].front *= belly;
    SolidGroup& torso = figure_.torso_solids;
    torso.join(loft(frame, rows, trunk_, 0.27f), 0.0f);
    const Vec3 shoulder = m_.shoulder;
    for (const float side : {1.0f, -1.0f}) {
      const Vec3 flip(side, 1.0f, 1.0f);
      torso.join(cone(flip * Vec3(0.035f, m_.neck + 0.020f, -0.036f),
                      flip * (shoulder + Vec3(-0.025f, 0.012f, -0.005f)), female_ ? 0.026f : 0.036f,
                      female_ ? 0.028f : 0.034f),
                 s(0.05f));
      // The muscle over the shoulder.
      torso.join(ball(flip * (shoulder + Vec3(0.004f, -0.012f, 0.002f)),
                      Vec3(0.052f, 0.060f, 0.056f) * (female_ ? 0.86f : 1.06f) * limbOnly()),
                 s(0.045f));
      if (female_) {
        torso.join(ball(flip * Vec3(0.068f, 1.222f, 0.072f) * Vec3(1, 1, trunk_),
                        Vec3(0.056f, 0.056f, 0.054f) * trunk_),
                   s(0.028f));
        torso.join(ball(flip * Vec3(0.076f, 0.868f, -0.056f), Vec3(0.086f, 0.092f, 0.072f) * trunk_),
                   s(0.04f));
      } else {
        torso.join(ball(flip * Vec3(0.075f, 1.355f, 0.062f), Vec3(0.086f, 0.058f, 0.044f) * trunk_),
                   s(0.035f));
        torso.join(ball(flip * Vec3(0.074f, 0.915f, -0.058f), Vec3(0.082f, 0.088f, 0.066f) * trunk_),
                   s(0.04f));
      }
    }
  }

  float limbOnly() const { return limb_ / m_.limb; }

  /// A point of the head of reference size, from a point between the ears.
  Vec3 fromHead(float x, float y, float z) const {
    const float top = m_.height - 0.100f * m_.head_size;
    return Vec3(0.0f, top, 0.0f) + Vec3(x, y, z) * m_.head_size;
  }
  Vec3 headSize(float x, float y, float z) const { return Vec3(x, y, z) * m_.head_size; }

  void buildHead() {
    SolidGroup& head = figure_.head_solids;
    const float jaw = female_ ? 0.76f : 0.96f;
    const float neck = (female_ ? 0.047f : 0.058f) * (1.0f + 0.08f * figure_.options.build);
    const float narrow = female_ ? 0.92f : 1.0f;
    head.join(ball(fromHead(0, 0.008f, -0.010f), headSize(0.0765f, 0.092f, 0.0975f)), 0.0f);
    head.join(ball(fromHead(0, -0.036f, 0.026f), headSize(0.062f * narrow, 0.084f, 0.071f)), s(0.03f));
    head.join(ball(fromHead(0, -0.090f, 0.040f), headSize(0.047f * jaw, 0.036f, 0.051f)), s(0.03f));
    for (const float side : {1.0f, -1.0f}) {
      head.join(cone(fromHead(side * 0.050f * jaw, -0.070f, 0.008f),
                     fromHead(side * 0.020f * jaw, -0.108f, 0.066f), 0.019f * jaw, 0.017f * jaw),
                s(0.025f));
    }
    head.join(ball(fromHead(0, -0.109f, 0.078f), headSize(0.024f * jaw, 0.0175f, 0.018f)), s(0.018f));
    const Solid column =
        cone(Vec3(0, m_.neck - 0.04f, -0.036f), fromHead(0, -0.06f, -0.014f), neck * 1.06f, neck);
    head.join(column, s(0.028f));
    figure_.neck_solids.join(column, 0.0f);
  }

  void buildFace() {
    SolidGroup& head = figure_.head_solids;
    const float soft = female_ ? 0.8f : 1.0f;
    for (const float side : {1.0f, -1.0f}) {
      head.join(cone(fromHead(side * 0.014f, 0.010f, 0.0855f), fromHead(side * 0.050f, 0.008f, 0.0655f),
                     0.0115f * soft, 0.0095f * soft),
                s(0.018f));
      head.join(ball(fromHead(side * 0.043f, -0.036f, 0.058f), headSize(0.024f, 0.020f, 0.026f)), s(0.028f));
      head.join(ball(fromHead(side * 0.034f, -0.068f, 0.052f),
                     headSize(0.026f * (female_ ? 0.72f : 1.0f), 0.034f, 0.030f)),
                s(0.030f));
    }
    for (const float side : {1.0f, -1.0f}) {
      head.carve(ball(fromHead(side * 0.032f, -0.0085f, 0.107f), headSize(0.022f, 0.0135f, 0.0200f)),
                 s(0.016f));
      head.join(ball(fromHead(side * 0.032f, -0.0095f, 0.0765f), headSize(0.0155f, 0.0120f, 0.0135f)),
                s(0.006f));
    }
    head.join(cone(fromHead(0, -0.004f, 0.0935f), fromHead(0, -0.046f, 0.1135f), 0.0080f,
                   0.0115f * (female_ ? 0.92f : 1.04f)),
              s(0.012f));
    for (const float side : {1.0f, -1.0f}) {
      head.join(ball(fromHead(side * 0.0115f, -0.0495f, 0.1025f), headSize(0.0088f, 0.0078f, 0.0105f)),
                s(0.007f));
      // Lips: two halves of a bow above, two below.
      head.join(cone(fromHead(side * 0.005f, -0.0770f, 0.0970f), fromHead(side * 0.0205f, -0.0800f, 0.0870f),
                     0.0072f, 0.0045f),
                s(0.009f));
      head.join(cone(fromHead(side * 0.004f, -0.0890f, 0.0960f), fromHead(side * 0.0180f, -0.0860f, 0.0875f),
                     0.0082f, 0.0050f),
                s(0.009f));
      const Mat3 flare = Mat3(glm::mat3_cast(glm::angleAxis(radians(side * -18.0f), Vec3(0, 1, 0)) *
                                             glm::angleAxis(radians(-10.0f), Vec3(1, 0, 0))));
      head.join(ball(fromHead(side * 0.0795f, -0.018f, -0.008f), headSize(0.0085f, 0.0315f, 0.0190f), flare),
                s(0.007f));
      head.carve(ball(fromHead(side * 0.0890f, -0.016f, -0.003f), headSize(0.0070f, 0.0180f, 0.0095f), flare),
                 s(0.006f));
    }
  }

  void buildArm() {
    SolidGroup& arm = figure_.arm_solids;
    const Vec3 front(0.0f, 0.0f, 1.0f);
    const float l = m_.upper_arm / 0.295f, f = m_.forearm / 0.258f;
    arm.join(loft(loftFrame(joint(kUpperArm), joint(kLowerArm), front),
                  {{0.000f * l, 0, 0, 0.049f, 0.053f, 0.053f},
                   {0.080f * l, 0, 0, 0.050f, 0.053f, 0.051f},
                   {0.165f * l, 0, 0.002f, 0.045f, 0.049f, 0.047f},
                   {0.245f * l, 0, 0, 0.039f, 0.041f, 0.041f},
                   {0.295f * l, 0, 0, 0.038f, 0.039f, 0.040f}},
                  limb_),
             0.0f);
    arm.join(loft(loftFrame(joint(kLowerArm), joint(kHand), front),
                  {{0.000f * f, 0, 0, 0.037f, 0.038f, 0.039f},
                   {0.060f * f, 0, 0.002f, 0.041f, 0.043f, 0.040f},
                   {0.150f * f, 0, 0, 0.033f, 0.036f, 0.034f},
                   {0.220f * f, 0, 0, 0.0235f, 0.0295f, 0.0285f},
                   {0.258f * f, 0, 0, 0.0205f, 0.0280f, 0.0270f}},
                  limb_),
             s(0.02f));
  }

  void buildHand() {
    SolidGroup& hand = figure_.hand_solids;
    const float size = hand_size_;
    std::vector<LoftRow> palm = {{-0.020f, 0, 0, 0.0195f, 0.027f, 0.026f},
                                 {0.010f, 0, 0, 0.0185f, 0.029f, 0.028f},
                                 {0.045f, 0, 0, 0.0165f, 0.037f, 0.036f},
                                 {0.080f, 0, 0, 0.0135f, 0.040f, 0.038f},
                                 {0.098f, 0, 0, 0.0105f, 0.037f, 0.035f}};
    for (LoftRow& row : palm) row.along *= size;
    const float thick = 0.5f * (size + limb_);
    hand.join(loft(hand_frame_, palm, thick, 0.35f), 0.0f);
    const auto phalanx = [&](const Vec3& a, const Vec3& b, float ra, float rb, float blend) {
      hand.join(Solid::roundCone(a, b, s(ra * thick), s(rb * thick)), s(blend));
    };
    for (std::size_t f = 0; f < 4; ++f) {
      const int first = kFingers[f].joint;
      const float slim = f == 3 ? 0.86f : 1.0f;
      phalanx(joint(first), joint(first + 1), 0.0090f * slim, 0.0082f * slim, 0.006f);
      phalanx(joint(first + 1), joint(first + 2), 0.0082f * slim, 0.0076f * slim, 0.002f);
      phalanx(joint(first + 2), finger_ends_[f], 0.0076f * slim, 0.0064f * slim, 0.002f);
    }
    phalanx(joint(kThumb1), joint(kThumb2), 0.0165f, 0.0115f, 0.016f);
    phalanx(joint(kThumb2), joint(kThumb3), 0.0112f, 0.0098f, 0.006f);
    phalanx(joint(kThumb3), thumb_end_, 0.0098f, 0.0078f, 0.003f);
  }

  void buildLeg() {
    SolidGroup& leg = figure_.leg_solids;
    const Vec3 front(0.0f, 0.0f, 1.0f);
    const float t = glm::distance(m_.hip, m_.knee) / 0.425f, c = glm::distance(m_.knee, m_.ankle) / 0.417f;
    const float hip = female_ ? 1.135f : 1.0f;  // a woman's thighs are fuller for her other limbs
    const auto thigh = [&](float y, float x, float side, float fore, float back) {
      const float fuller = 1.0f + (hip - 1.0f) * (1.0f - 0.5f * y / 0.425f);
      return LoftRow{y * t, x, 0, side * fuller, fore * fuller, back * fuller};
    };
    leg.join(loft(loftFrame(joint(kThigh), joint(kCalf), front),
                  {thigh(0.0f, 0, 0.086f, 0.090f, 0.088f), thigh(0.10f, 0, 0.084f, 0.090f, 0.087f),
                   thigh(0.22f, 0, 0.073f, 0.080f, 0.075f), thigh(0.34f, 0, 0.059f, 0.064f, 0.060f),
                   thigh(0.425f, 0, 0.052f, 0.055f, 0.053f)},
                  limb_),
             0.0f);
    leg.join(loft(loftFrame(joint(kCalf), joint(kFoot), front),
                  {{0.000f * c, 0, 0, 0.052f, 0.054f, 0.052f},
                   {0.060f * c, 0, 0, 0.051f, 0.048f, 0.058f},
                   {0.130f * c, 0, 0, 0.054f, 0.044f, 0.067f},
                   {0.220f * c, 0, 0, 0.047f, 0.041f, 0.054f},
                   {0.320f * c, 0, 0, 0.036f, 0.037f, 0.039f},
                   {0.400f * c, 0, 0, 0.0325f, 0.0365f, 0.040f}},
                  limb_ * (female_ ? 1.06f : 1.0f)),
             s(0.025f));
    leg.join(ball(m_.knee + Vec3(0, 0.004f, 0.040f * limb_), Vec3(0.030f, 0.038f, 0.017f) * limb_), s(0.02f));
  }

  void buildFoot() {
    SolidGroup& foot = figure_.foot_solids;
    const float size = m_.ball.z / 0.105f;
    const float wide = 0.5f * (size + limb_);
    const LoftFrame frame =
        loftFrame(s(Vec3(m_.ankle.x, 0, 0)), s(Vec3(m_.ankle.x + 0.10f, 0, 1)), Vec3(0.0f, 1.0f, 0.0f));
    std::vector<LoftRow> rows = {
        {-0.055f, 0, 0.036f, 0.029f, 0.042f, 0.046f}, {-0.018f, 0, 0.042f, 0.032f, 0.050f, 0.052f},
        {0.040f, 0, 0.036f, 0.036f, 0.040f, 0.046f},  {0.095f, 0, 0.024f, 0.045f, 0.026f, 0.034f},
        {0.130f, 0, 0.016f, 0.045f, 0.018f, 0.026f},  {0.158f, 0, 0.012f, 0.037f, 0.013f, 0.020f}};
    for (LoftRow& row : rows) {
      row.along *= size;
      row.center_z *= size;
    }
    foot.join(loft(frame, rows, wide, 0.18f), 0.0f);
    foot.join(cone(m_.ankle + Vec3(0, 0.03f, 0.003f), m_.ankle + Vec3(0, -0.02f, 0.006f), 0.035f * limb_,
                   0.038f * limb_),
              s(0.03f));
    for (const float side : {1.0f, -1.0f}) {
      foot.join(
          ball(m_.ankle + Vec3(side * 0.030f * limb_, side * -0.004f, 0.004f), Vec3(0.010f, 0.014f, 0.013f)),
          s(0.015f));
    }
    // Toes, the big one inside.
    for (int toe = 0; toe < 5; ++toe) {
      const float x = -0.031f + 0.0165f * static_cast<float>(toe) - (toe == 0 ? 0.002f : 0.0f);
      const float tip = (0.176f - 0.006f * static_cast<float>(toe * toe) * 0.55f) * size;
      const float radius = toe == 0 ? 0.0125f : 0.0085f;
      const auto at = [&](float along, float up) {
        return frame.origin + frame.world_from_local * s(Vec3(-x * wide, along, up));
      };
      foot.join(Solid::roundCone(at(tip - 0.04f, 0.014f), at(tip - radius, radius * 0.9f), s(radius),
                                 s(radius * 0.92f)),
                s(0.006f));
    }
  }

  const Measures& m_;
  const bool female_;
  Figure figure_;
  float trunk_ = 1.0f, limb_ = 1.0f, hand_size_ = 1.0f;
  LoftFrame hand_frame_;
  std::array<Vec3, 4> finger_ends_{};
  Vec3 thumb_end_{0.0f};
};

Vec3 toLeft(const Vec3& p) { return {std::abs(p.x), p.y, p.z}; }

}  // namespace

float Figure::head(const Vec3& p) const { return head_solids.distance(toLeft(p)); }
float Figure::torso(const Vec3& p) const { return torso_solids.distance(toLeft(p)); }
float Figure::arm(const Vec3& p) const { return arm_solids.distance(toLeft(p)); }
float Figure::hand(const Vec3& p) const { return hand_solids.distance(toLeft(p)); }
float Figure::foot(const Vec3& p) const {
  // The ground cuts the sole flat.
  return smoothMax(foot_solids.distance(toLeft(p)), -p.y, 0.014f * scale);
}

float Figure::leg(const Vec3& p) const {
  const float left = leg_solids.distance(p);
  const float right = leg_solids.distance({-p.x, p.y, p.z});
  return smoothMin(left, right, 0.02f * scale);
}

float Figure::body(const Vec3& p) const {
  float value = smoothMin(torso(p), head(p), 0.035f * scale);
  value = smoothMin(value, leg(p), 0.035f * scale);
  value = smoothMin(value, arm(p), 0.03f * scale);
  value = smoothMin(value, hand(p), 0.012f * scale);
  return smoothMin(value, foot(p), 0.018f * scale);
}

Vec3 Figure::armAxis() const { return glm::normalize(joints[kLowerArm] - joints[kUpperArm]); }

Figure makeFigure(const FigureOptions& options) { return Builder(options).run(); }

}  // namespace ensemble
