// Trousers, shorts, a skirt: hips and legs offset outwards, joined with legs of cloth that hang.
#include <algorithm>
#include <cmath>

#include "assetpipe/people_garments.h"

namespace ensemble {
namespace {

Vec3 toLeft(const Vec3& p) { return {std::abs(p.x), p.y, p.z}; }

float lowerBody(const Figure& f, const Vec3& p) { return smoothMin(f.torso(p), f.leg(p), 0.035f * f.scale); }

struct LegCut {
  float offset = 0.008f;                          // metres off the skin
  float waist_y = 1.0f, hem_y = 0.05f;            // metres
  float thigh = 0.0f, knee = 0.0f, ankle = 0.0f;  // radii of the legs of cloth, 0: none
  float belt = 0.035f;                            // width of the band at the waist, metres
};

void cutLegs(GarmentDesign& design, const Figure& f, const LegCut& cut) {
  const float limb = f.scale * f.limb * (f.isFemale() ? 1.10f : 1.0f);
  SolidGroup legs;
  if (cut.thigh > 0.0f) {
    legs.join(Solid::roundCone(glm::mix(f.joints[kThigh], f.joints[kCalf], 0.25f), f.joints[kCalf],
                               cut.thigh * limb, cut.knee * limb),
              0.0f);
  }
  if (cut.ankle > 0.0f) {
    legs.join(Solid::roundCone(f.joints[kCalf], f.joints[kFoot] - Vec3(0, 0.06f * f.scale, 0.005f * f.scale),
                               cut.knee * limb, cut.ankle * limb),
              0.03f * f.scale);
  }
  const Field belt = [cut](const Vec3& p) { return p.y + 0.10f * p.z - cut.waist_y + cut.belt; };
  design.shell = [&f, cut, legs, belt](const Vec3& p) {
    float value = lowerBody(f, p);
    if (!legs.empty()) value = smoothMin(value, legs.distance(toLeft(p)), 0.03f * f.scale);
    // Long legs fall over the shoe's instep.
    if (cut.hem_y < f.joints[kFoot].y)
      value = smoothMin(value, f.foot(p) - 0.006f * f.scale, 0.03f * f.scale);
    return value - cut.offset - 0.0025f * f.scale * smoothStep(-0.003f, 0.003f, belt(p));
  };
  // The waistband is a little higher at the back.
  // So is the front of the hem, over the instep.
  const float slope = cut.hem_y < f.joints[kFoot].y ? 0.30f : 0.0f;
  design.opening = [cut, slope, ankle_z = f.joints[kFoot].z](const Vec3& p) {
    return std::max(p.y + 0.10f * p.z - cut.waist_y, cut.hem_y + slope * std::max(p.z - ankle_z, 0.0f) - p.y);
  };
  design.binding = [&f](const Vec3& p) { return bodyBinding(f, p); };
  const float s = f.scale;
  design.importance = [&f, s](const Vec3& p) {
    return 0.7f + 1.2f * (1.0f - smoothStep(0.08f * s, 0.16f * s, std::abs(p.y - f.joints[kCalf].y)));
  };
  design.low = Vec3(-0.32f * s, cut.hem_y - 0.02f, -0.30f * s);
  design.high = Vec3(0.32f * s, cut.waist_y + 0.05f * s, 0.30f * s);
  design.seams = {belt};
  design.label = [belt](const Vec3& p) { return static_cast<std::uint8_t>(belt(p) > 0.0f ? 1 : 0); };
}

/// Stripes down the outside of the legs instead of a belt.
void addStripes(GarmentDesign& design, const Figure& f) {
  const Field stripe = [&f](const Vec3& p) {
    const float s = f.scale;
    const bool below_knee = p.y < f.joints[kCalf].y;
    const Vec3 from = f.joints[below_knee ? kCalf : kThigh], to = f.joints[below_knee ? kFoot : kCalf];
    const Vec3 axis = glm::mix(from, to, std::max((from.y - p.y) / (from.y - to.y), -0.3f));
    return std::min(0.014f * s - std::abs(p.z - axis.z), std::abs(p.x) - axis.x);
  };
  design.seams = {stripe};
  design.label = [stripe](const Vec3& p) { return static_cast<std::uint8_t>(stripe(p) > 0.0f ? 1 : 0); };
}

}  // namespace

GarmentDesign designJeans(const Figure& f, const Palette& palette) {
  GarmentDesign design;
  design.name = "cloth.jeans";
  design.materials = {clothMaterial("cloth.jeans", palette.main),
                      clothMaterial("cloth.jeans.belt", palette.second)};
  const bool slim = f.isFemale();
  LegCut cut;
  cut.offset = 0.009f;
  cut.waist_y = f.joints[kPelvis].y + (slim ? 0.045f : 0.030f) * f.scale;
  cut.hem_y = f.joints[kFoot].y + (slim ? 0.014f : -0.035f) * f.scale;
  cut.thigh = slim ? 0.070f : 0.080f;
  cut.knee = slim ? 0.052f : 0.061f;
  cut.ankle = slim ? 0.043f : 0.066f;
  cutLegs(design, f, cut);
  design.face_count = 1400;
  return design;
}

GarmentDesign designTrousers(const Figure& f, const Palette& palette) {
  GarmentDesign design;
  design.name = "cloth.trousers";
  design.materials = {clothMaterial("cloth.trousers", palette.main),
                      clothMaterial("cloth.trousers.belt", palette.second)};
  LegCut cut;
  cut.offset = 0.009f;
  cut.waist_y = f.joints[kPelvis].y + 0.060f * f.scale;
  cut.hem_y = f.joints[kFoot].y - 0.050f * f.scale;
  cut.thigh = 0.080f;
  cut.knee = 0.067f;
  cut.ankle = 0.069f;
  cutLegs(design, f, cut);
  design.face_count = 1300;
  return design;
}

GarmentDesign designShorts(const Figure& f, const Palette& palette) {
  GarmentDesign design;
  design.name = "cloth.shorts";
  design.materials = {clothMaterial("cloth.shorts", palette.main),
                      clothMaterial("cloth.shorts.stripe", palette.second)};
  LegCut cut;
  cut.offset = 0.011f;
  cut.waist_y = f.joints[kPelvis].y + 0.030f * f.scale;
  cut.hem_y = f.joints[kCalf].y + 0.055f * f.scale;
  cut.thigh = 0.090f;
  cut.knee = 0.092f;
  cutLegs(design, f, cut);
  addStripes(design, f);
  design.cover_margin = 0.05f;
  design.face_count = 1000;
  return design;
}

GarmentDesign designLeggings(const Figure& f, const Palette& palette) {
  GarmentDesign design;
  design.name = "cloth.leggings";
  design.materials = {clothMaterial("cloth.leggings", palette.main),
                      clothMaterial("cloth.leggings.stripe", palette.second)};
  LegCut cut;
  cut.offset = 0.005f;
  cut.waist_y = f.joints[kPelvis].y + 0.060f * f.scale;
  cut.hem_y = f.joints[kFoot].y + 0.055f * f.scale;
  cutLegs(design, f, cut);
  addStripes(design, f);
  design.face_count = 1300;
  return design;
}

GarmentDesign designSkirt(const Figure& f, const Palette& palette) {
  GarmentDesign design;
  design.name = "cloth.skirt";
  design.materials = {clothMaterial("cloth.skirt", palette.main)};
  const float s = f.scale, t = f.trunk * s;
  const float waist = f.joints[kSpine1].y + 0.015f * s, hem_y = f.joints[kCalf].y + 0.035f * s;
  const float hip = f.joints[kThigh].y;
  SolidGroup column;
  column.join(Solid::loft({Vec3(0.0f), Mat3(1.0f)},
                          {{hem_y - 0.03f * s, 0, 0, 0.178f * t, 0.125f * t, 0.135f * t},
                           {hip - 0.20f * s, 0, 0, 0.178f * t, 0.116f * t, 0.128f * t},
                           {hip - 0.04f * s, 0, 0, 0.172f * t, 0.104f * t, 0.118f * t},
                           {waist + 0.02f * s, 0, 0, 0.130f * t, 0.090f * t, 0.082f * t}},
                          0.18f),
              0.0f);
  design.shell = [&f, column, s](const Vec3& p) {
    return smoothMin(lowerBody(f, p), column.distance(p), 0.03f * s) - 0.008f;
  };
  design.opening = [waist, hem_y](const Vec3& p) { return std::max(p.y - waist, hem_y - p.y); };
  design.binding = [&f](const Vec3& p) { return skirtBinding(f, p, 0.35f); };
  design.low = Vec3(-0.35f * s, hem_y - 0.02f, -0.30f * s);
  design.high = Vec3(0.35f * s, waist + 0.05f * s, 0.30f * s);
  design.cover_margin = 0.10f;
  design.face_count = 900;
  return design;
}

}  // namespace ensemble
