// Proportions follow the usual anthropometric tables (segment lengths as parts of the height, breadths
// and girths of adults); the shapes are ours, tuned by eye.
#include "assetpipe/people_figure.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "assetpipe/people_builder.h"

namespace ensemble {
namespace {

constexpr Measures kMan = {1.76f,
                           0.965f,
                           1.06f,
                           1.17f,
                           1.29f,
                           1.497f,
                           1.588f,
                           {0.025f, 1.45f, 0.0f},
                           {0.188f, 1.437f, -0.02f},
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
                             {0.158f, 1.354f, -0.018f},
                             {0.088f, 0.868f, 0.0f},
                             {0.094f, 0.468f, 0.012f},
                             {0.098f, 0.079f, -0.024f},
                             {0.108f, 0.021f, 0.095f},
                             0.274f,
                             0.238f,
                             0.174f,
                             0.86f,
                             0.955f};

/// A person's own measures: frame and age move the joints.
Measures measuresOf(const FigureOptions& options) {
  Measures m = options.sex == Sex::kMale ? kMan : kWoman;
  const bool is_young = options.age == AgeGroup::kYoung;
  m.shoulder.x *= (1.0f + 0.055f * options.build) * (is_young ? 0.955f : 1.0f);
  // Heads differ less than heights do, and a youngster's is large for the body.
  m.head_size *= std::pow(options.height / m.height, -0.45f) * (is_young ? 1.035f : 1.0f);
  if (is_young) m.limb *= 0.92f;
  if (options.age == AgeGroup::kOld) m.limb *= 0.95f;
  return m;
}

}  // namespace

FigureBuilder::FigureBuilder(const FigureOptions& options)
    : m_(measuresOf(options)),
      female_(options.sex == Sex::kFemale),
      old_(options.age == AgeGroup::kOld),
      girth_(options.girth),
      build_(options.build) {
  stoop_ = old_ ? 1.0f : 0.0f;
  figure_.options = options;
  figure_.scale = options.height / (m_.height - 0.018f * stoop_);
  trunk_ = 1.0f + (girth_ > 0.0f ? 0.17f : 0.085f) * girth_ + 0.025f * build_ +
           (options.age == AgeGroup::kYoung ? -0.045f : 0.0f);
  limb_ = m_.limb * (1.0f + 0.085f * girth_ + 0.060f * build_);
  muscle_ = (1.0f + 0.25f * build_) * (options.age == AgeGroup::kAdult ? 1.0f : 0.85f);
  figure_.trunk = trunk_;
  figure_.limb = limb_;
  figure_.head_center = at(fromHead(0.0f, 0.0f, 0.0f));
  figure_.head_size = figure_.scale * m_.head_size;
}

Figure FigureBuilder::run() {
  placeTrunkJoints();
  placeArmJoints();
  buildTorso();
  buildHead();
  buildArm();
  buildHand();
  buildLeg();
  buildFoot();
  return std::move(figure_);
}

Vec3 FigureBuilder::at(const Vec3& point) const {
  // An old back is round: from the waist up it leans forward, the head most.
  const float t = smoothStep(m_.spine1, m_.head, point.y) * stoop_;
  return (point + Vec3(0.0f, -0.018f * t, 0.052f * t * t - 0.022f * t * (1.0f - t))) * figure_.scale;
}

Solid FigureBuilder::cone(const Vec3& a, const Vec3& b, float radius_a, float radius_b) const {
  return Solid::roundCone(at(a), at(b), s(radius_a), s(radius_b));
}

Solid FigureBuilder::ball(const Vec3& center, const Vec3& radii, const Mat3& turn) const {
  return Solid::ellipsoid(at(center), radii * figure_.scale, turn);
}

Solid FigureBuilder::loft(const LoftFrame& frame, std::vector<LoftRow> rows, float thick,
                          float boxiness) const {
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

void FigureBuilder::placeTrunkJoints() {
  joint(kRoot) = Vec3(0.0f);
  joint(kPelvis) = at(Vec3(0.0f, m_.pelvis, 0.0f));
  joint(kSpine1) = at(Vec3(0.0f, m_.spine1, -0.005f));
  joint(kSpine2) = at(Vec3(0.0f, m_.spine2, -0.010f));
  joint(kSpine3) = at(Vec3(0.0f, m_.spine3, -0.018f));
  joint(kNeck) = at(Vec3(0.0f, m_.neck, -0.030f));
  joint(kHead) = at(Vec3(0.0f, m_.head, -0.008f));
  figure_.head_top = at(Vec3(0.0f, m_.height, 0.0f));
  joint(kThigh) = at(m_.hip);
  joint(kCalf) = at(m_.knee);
  joint(kFoot) = at(m_.ankle);
  joint(kBall) = at(m_.ball);
  figure_.toe_end = at(m_.ball + Vec3(0.006f, -0.008f, 0.075f));
  for (int i = 0; i < kRightLeg; ++i) {
    joint(kThigh + kRightLeg + i) = Vec3(-1.0f, 1.0f, 1.0f) * joint(kThigh + i);
  }
}

void FigureBuilder::buildTorso() {
  const float fat = std::max(girth_, 0.0f);
  // Where flesh goes: to the belly first, in old age without being asked.
  const float belly = 1.0f + 0.20f * fat + (old_ ? 0.10f : 0.0f);
  std::vector<LoftRow> rows;
  if (female_) {
    rows = {{0.880f, 0, 0.000f, 0.164f, 0.092f, 0.098f},  {0.930f, 0, 0.000f, 0.164f, 0.095f, 0.098f},
            {0.985f, 0, 0.000f, 0.147f, 0.095f, 0.088f},  {1.040f, 0, 0.000f, 0.126f, 0.090f, 0.079f},
            {1.095f, 0, 0.000f, 0.118f, 0.087f, 0.077f},  {1.160f, 0, -0.004f, 0.126f, 0.088f, 0.086f},
            {1.230f, 0, -0.010f, 0.135f, 0.090f, 0.092f}, {1.295f, 0, -0.015f, 0.137f, 0.080f, 0.094f},
            {1.345f, 0, -0.020f, 0.124f, 0.062f, 0.083f}, {1.385f, 0, -0.026f, 0.090f, 0.044f, 0.062f}};
  } else {
    rows = {{0.930f, 0, 0.003f, 0.160f, 0.096f, 0.104f},  {0.990f, 0, 0.002f, 0.159f, 0.100f, 0.102f},
            {1.060f, 0, 0.000f, 0.149f, 0.103f, 0.090f},  {1.130f, 0, 0.000f, 0.146f, 0.102f, 0.086f},
            {1.220f, 0, -0.004f, 0.157f, 0.106f, 0.098f}, {1.310f, 0, -0.008f, 0.172f, 0.112f, 0.110f},
            {1.380f, 0, -0.014f, 0.175f, 0.102f, 0.112f}, {1.440f, 0, -0.022f, 0.155f, 0.074f, 0.094f},
            {1.478f, 0, -0.028f, 0.112f, 0.052f, 0.070f}};
  }
  const float broad = m_.shoulder.x / (female_ ? kWoman : kMan).shoulder.x;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i < 5) rows[i].front *= belly;
    if (i > 0 && i < 5) rows[i].side *= 1.0f + 0.08f * fat + (old_ ? 0.04f : 0.0f);
    if (i > 4) rows[i].side *= broad;
    // Lofts are built upright, so they take the stoop row by row.
    const Vec3 stooped = at(Vec3(0.0f, rows[i].along, rows[i].center_z)) / figure_.scale;
    rows[i].along = stooped.y;
    rows[i].center_z = stooped.z;
  }
  SolidGroup& torso = figure_.torso_solids;
  torso.join(loft({Vec3(0.0f), Mat3(1.0f)}, rows, trunk_, 0.27f), 0.0f);
  // A paunch; without flesh it lies inside the trunk.
  const float paunch = std::min(fat + (old_ ? 0.25f : 0.0f), 1.0f);
  torso.join(ball(Vec3(0.0f, m_.spine1 + 0.025f, 0.030f + 0.030f * paunch),
                  Vec3(0.115f, 0.125f, 0.055f + 0.050f * paunch) * trunk_),
             s(0.05f));
  for (const float side : {1.0f, -1.0f}) {
    const Vec3 flip(side, 1.0f, 1.0f);
    buildShoulders(flip);
    if (female_) {
      buildBreast(flip);
      torso.join(ball(flip * Vec3(0.076f, 0.868f, -0.056f), Vec3(0.086f, 0.092f, 0.072f) * trunk_), s(0.04f));
    } else {
      // The chest's muscle, or what has become of it.
      torso.join(ball(flip * Vec3(0.080f, 1.352f - 0.012f * fat, 0.060f),
                      Vec3(0.088f, 0.060f, 0.046f * muscle_) * trunk_),
                 s(0.035f));
      torso.join(ball(flip * Vec3(0.074f, 0.915f, -0.058f), Vec3(0.082f, 0.088f, 0.066f) * trunk_), s(0.04f));
    }
  }
  // The groove along the spine.
  const float behind = (female_ ? -0.090f : -0.106f) * trunk_;
  torso.carve(cone(Vec3(0.0f, m_.spine1 + 0.02f, behind + 0.006f),
                   Vec3(0.0f, m_.spine3 + 0.09f, behind - 0.030f), 0.006f, 0.005f),
              s(0.030f));
}

void FigureBuilder::buildBreast(const Vec3& flip) {
  SolidGroup& torso = figure_.torso_solids;
  const float full = 1.0f + 0.12f * girth_ - (figure_.options.age == AgeGroup::kYoung ? 0.16f : 0.0f);
  const float sunk = old_ ? 0.030f : 0.006f * std::max(girth_, 0.0f);
  const float out = 0.072f * trunk_;
  torso.join(cone(flip * Vec3(0.068f, 1.298f - sunk, out - 0.034f),
                  flip * Vec3(0.071f, 1.222f - sunk, out + 0.002f), 0.026f * full, 0.0505f * full),
             s(0.030f));
}

void FigureBuilder::buildShoulders(const Vec3& flip) {
  SolidGroup& torso = figure_.torso_solids;
  const Vec3 shoulder = m_.shoulder;
  const float slim = female_ ? 0.82f : 1.0f;
  const float neck = m_.neck - 1.497f;  // the woman's measures are the man's, moved down
  // From the neck down to the shoulder's end.
  torso.join(
      cone(flip * Vec3(0.030f, m_.neck + 0.034f, -0.040f), flip * (shoulder + Vec3(-0.026f, 0.014f, -0.006f)),
           (female_ ? 0.021f : 0.030f) * (0.7f + 0.3f * muscle_), 0.036f * slim),
      s(female_ ? 0.040f : 0.055f));
  torso.join(ball(flip * (shoulder + Vec3(-0.008f, -0.018f, 0.0f)), Vec3(0.052f, 0.056f, 0.052f) * slim),
             s(0.045f));
  // Collar bone and shoulder blade.
  torso.join(cone(flip * Vec3(0.020f, 1.455f + neck, female_ ? 0.034f : 0.046f),
                  flip * (shoulder + Vec3(-0.028f, 0.024f, 0.010f)), 0.008f, 0.010f),
             s(0.026f));
  torso.join(ball(flip * Vec3(0.088f * slim, 1.355f + neck, female_ ? -0.068f : -0.082f),
                  Vec3(0.054f, 0.085f, 0.038f) * slim),
             s(0.045f));
  if (female_) return;
  // The broad muscle of the back makes the trunk a wedge.
  torso.join(ball(flip * Vec3(0.128f, 1.315f, -0.040f), Vec3(0.046f, 0.110f, 0.058f) * muscle_), s(0.05f));
}

namespace {

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
  const Vec3 left = toLeft(p);
  float value = torso(p);
  // A limb farther away than its blend changes nothing and is not looked at.
  const auto join = [&](const SolidGroup& group, float blend, const auto& distance) {
    if (group.lowerBound(left) < value + blend) value = smoothMin(value, distance(p), blend);
  };
  join(head_solids, 0.035f * scale, [this](const Vec3& q) { return head(q); });
  join(leg_solids, 0.035f * scale, [this](const Vec3& q) { return leg(q); });
  join(arm_solids, 0.03f * scale, [this](const Vec3& q) { return arm(q); });
  join(hand_solids, 0.012f * scale, [this](const Vec3& q) { return hand(q); });
  join(foot_solids, 0.018f * scale, [this](const Vec3& q) { return foot(q); });
  return value;
}

Vec3 Figure::armAxis() const { return glm::normalize(joints[kLowerArm] - joints[kUpperArm]); }

Figure makeFigure(const FigureOptions& options) { return FigureBuilder(options).run(); }

}  // namespace ensemble
