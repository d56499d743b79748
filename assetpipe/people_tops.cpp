// Shirts, jackets, a hoodie and a dress: the trunk and arms offset outwards, joined with what hangs.
#include <algorithm>
#include <cmath>

#include "assetpipe/people_garments.h"

namespace ensemble {
namespace {

Vec3 toLeft(const Vec3& p) { return {std::abs(p.x), p.y, p.z}; }

/// What a top is tailored over.
float upperBody(const Figure& f, const Vec3& p) {
  const float s = f.scale;
  float value = smoothMin(f.torso(p), f.neck_solids.distance(p), 0.035f * s);
  value = smoothMin(value, f.leg(p), 0.035f * s);
  return smoothMin(value, f.arm(p), 0.03f * s);
}

/// Positive beyond the end of a sleeve that is `part` of the upper arm (to 1) and forearm (to 2) long.
float sleeveEnd(const Figure& f, const Vec3& p, float part) {
  const Vec3 left = toLeft(p);
  const Vec3 shoulder = f.joints[kUpperArm], elbow = f.joints[kLowerArm], wrist = f.joints[kHand];
  const Vec3 from = part < 1.0f ? shoulder : elbow, to = part < 1.0f ? elbow : wrist;
  const float along =
      glm::dot(left - glm::mix(from, to, part < 1.0f ? part : part - 1.0f), glm::normalize(to - from));
  const float on_arm = std::min(f.torso(p), f.leg(p)) - std::min(f.arm(p), f.hand(p));
  return std::min(along, on_arm);
}

/// A hanging column around the trunk; rows as heights in reference metres.
Solid drape(const Figure& f, std::vector<LoftRow> rows) {
  for (LoftRow& row : rows) {
    row.along *= f.scale;
    row.center_z *= f.scale;
    row.side *= f.scale * f.trunk;
    row.front *= f.scale * f.trunk;
    row.back *= f.scale * f.trunk;
  }
  return Solid::loft({Vec3(0.0f), Mat3(1.0f)}, std::move(rows), 0.27f);
}

/// Sleeves that stand off the arm: radii at the shoulder, the elbow and the wrist.
SolidGroup sleeves(const Figure& f, float shoulder, float elbow, float wrist) {
  const float s = f.scale * f.limb;
  SolidGroup group;
  group.join(Solid::roundCone(f.joints[kUpperArm], f.joints[kLowerArm], shoulder * s, elbow * s), 0.0f);
  if (wrist > 0.0f) {
    group.join(Solid::roundCone(f.joints[kLowerArm], f.joints[kHand], elbow * s, wrist * s), 0.02f * f.scale);
  }
  return group;
}

struct TopCut {
  float offset = 0.009f;     // metres off the skin
  float hem_y = 0.9f;        // metres
  float neck_rise = 0.012f;  // of the neckline over the neck's base, metres of the reference figure
  float neck_wide = 0.075f;  // its radius, likewise
  float sleeve = 0.6f;       // length, see sleeveEnd
};

float topNeck(const Figure& f, const Vec3& p, const TopCut& cut, float further = 0.0f) {
  const float slim = f.isFemale() ? 0.84f : 1.0f;
  return neckline(f, p, cut.neck_rise - further, cut.neck_wide * slim + further);
}

/// Shell and opening of an ordinary top.
void cutTop(GarmentDesign& design, const Figure& f, const TopCut& cut, const SolidGroup& hanging,
            const SolidGroup& sleeve) {
  design.shell = [&f, cut, hanging, sleeve](const Vec3& p) {
    float value = upperBody(f, p);
    value = smoothMin(value, hanging.distance(p), 0.03f * f.scale);
    value = smoothMin(value, sleeve.distance(toLeft(p)), 0.025f * f.scale);
    return value - cut.offset;
  };
  design.opening = [&f, cut](const Vec3& p) {
    return std::max({cut.hem_y - p.y, topNeck(f, p, cut), sleeveEnd(f, p, cut.sleeve)});
  };
  design.binding = [&f](const Vec3& p) { return bodyBinding(f, p); };
  const float s = f.scale;
  design.low = Vec3(-0.75f * s, cut.hem_y - 0.02f, -0.30f * s);
  design.high = Vec3(0.75f * s, f.head_center.y, 0.30f * s);
}

SolidGroup tshirtDrape(const Figure& f, float looser) {
  SolidGroup group;
  const float l = looser;
  if (f.isFemale()) {
    group.join(drape(f, {{0.86f, 0, 0, 0.160f + l, 0.094f + l, 0.100f + l},
                         {0.96f, 0, 0, 0.152f + l, 0.096f + l, 0.094f + l},
                         {1.04f, 0, 0, 0.138f + l, 0.094f + l, 0.088f + l},
                         {1.13f, 0, 0, 0.134f + l, 0.100f + l, 0.088f + l},
                         {1.20f, 0, -0.004f, 0.135f + l, 0.104f + l, 0.090f + l}}),
               0.0f);
  } else {
    group.join(drape(f, {{0.88f, 0, 0, 0.160f + l, 0.104f + l, 0.108f + l},
                         {1.00f, 0, 0, 0.160f + l, 0.107f + l, 0.103f + l},
                         {1.12f, 0, 0, 0.157f + l, 0.109f + l, 0.100f + l},
                         {1.24f, 0, -0.004f, 0.162f + l, 0.113f + l, 0.106f + l},
                         {1.32f, 0, -0.008f, 0.166f + l, 0.116f + l, 0.112f + l}}),
               0.0f);
  }
  return group;
}

float hipHeight(const Figure& f) { return f.joints[kThigh].y; }

}  // namespace

GarmentDesign designTshirt(const Figure& f, const Palette& palette) {
  GarmentDesign design;
  design.name = "cloth.tshirt";
  design.materials = {clothMaterial("cloth.tshirt", palette.main)};
  TopCut cut;
  cut.offset = 0.010f;
  cut.hem_y = hipHeight(f) - 0.030f * f.scale;
  cut.neck_rise = -0.012f;
  cut.neck_wide = 0.080f;
  cut.sleeve = 0.66f;
  cutTop(design, f, cut, tshirtDrape(f, 0.004f), sleeves(f, 0.060f, 0.060f, 0.0f));
  // A ribbed band around the neck.
  design.shell = [&f, cut, inner = design.shell](const Vec3& p) {
    const float s = f.scale;
    return inner(p) - 0.0025f * s * smoothStep(-0.002f * s, 0.002f * s, topNeck(f, p, cut, 0.014f));
  };
  design.face_count = 1500;
  return design;
}

GarmentDesign designShirt(const Figure& f, const Palette& palette) {
  GarmentDesign design;
  design.name = "cloth.shirt";
  design.materials = {clothMaterial("cloth.shirt", palette.main), clothMaterial("cloth.tie", palette.second)};
  TopCut cut;
  cut.offset = 0.007f;
  cut.hem_y = hipHeight(f) + 0.020f * f.scale;
  cut.neck_rise = 0.026f;
  cut.sleeve = 1.98f;
  cutTop(design, f, cut, tshirtDrape(f, -0.004f), sleeves(f, 0.052f, 0.046f, 0.034f));
  const float s = f.scale;
  // The tie hangs from the collar to the belt, a knot above.
  const Field tie = [&f, s](const Vec3& p) {
    const float down = (f.joints[kNeck].y - 0.015f * s - p.y) / s;
    const float half =
        down < 0.045f ? 0.019f - 0.1f * std::max(down, 0.0f) : 0.0145f + 0.060f * (down - 0.045f);
    const float side = half * s - std::abs(p.x);
    return std::min({side, p.z - 0.02f * s, down * s + 0.028f * s, 0.46f * s - down * s - std::abs(p.x)});
  };
  const Field collar = [&f, cut](const Vec3& p) { return topNeck(f, p, cut, 0.038f); };
  design.shell = [inner = design.shell, tie, collar, s](const Vec3& p) {
    const float raised = 0.0045f * s * smoothStep(-0.003f * s, 0.003f * s, tie(p));
    const float band = 0.004f * s * smoothStep(-0.004f * s, 0.004f * s, collar(p));
    return inner(p) - std::max(raised, band);
  };
  design.seams = {tie};
  design.label = [tie](const Vec3& p) { return static_cast<std::uint8_t>(tie(p) > 0.0f ? 1 : 0); };
  design.face_count = 1500;
  return design;
}

GarmentDesign designBlouse(const Figure& f, const Palette& palette) {
  GarmentDesign design;
  design.name = "cloth.blouse";
  design.materials = {clothMaterial("cloth.blouse", palette.main)};
  TopCut cut;
  cut.offset = 0.007f;
  cut.hem_y = f.joints[kPelvis].y + 0.030f * f.scale;
  cut.neck_rise = 0.004f;
  cut.sleeve = 1.85f;
  cutTop(design, f, cut, tshirtDrape(f, 0.000f), sleeves(f, 0.052f, 0.048f, 0.036f));
  // A V-neck.
  design.opening = [inner = design.opening, &f](const Vec3& p) {
    const float s = f.scale;
    const float depth = p.y - (f.joints[kNeck].y - 0.135f * s);
    const float vee = p.z > 0.0f ? 0.48f * depth - std::abs(p.x) : -s;
    return std::max(inner(p), std::min(vee, p.z));
  };
  design.face_count = 1400;
  return design;
}

GarmentDesign designHoodie(const Figure& f, const Palette& palette) {
  GarmentDesign design;
  design.name = "cloth.hoodie";
  design.materials = {clothMaterial("cloth.hoodie", palette.main),
                      clothMaterial("cloth.hoodie.cuffs", palette.second)};
  const float s = f.scale;
  TopCut cut;
  cut.offset = 0.019f;
  cut.hem_y = hipHeight(f) - 0.010f * s;
  cut.neck_rise = 0.006f;
  cut.neck_wide = 0.084f;
  cut.sleeve = 1.97f;
  SolidGroup hanging = tshirtDrape(f, 0.007f);
  // The hood lies behind the neck and comes around to the chest.
  const float neck = f.joints[kNeck].y, wide = f.isFemale() ? 0.86f : 1.0f;
  const auto at = [&](float x, float y, float z) { return Vec3(x * wide * s, neck + y * s, z * s); };
  SolidGroup hood;
  hood.join(Solid::ellipsoid(at(0.0f, -0.004f, -0.104f), Vec3(0.098f * wide, 0.070f, 0.046f) * s), 0.0f);
  hood.join(
      Solid::roundCone(at(0.058f, 0.026f, -0.088f), at(0.090f, 0.014f, -0.018f), 0.036f * s, 0.026f * s),
      0.03f * s);
  hood.join(
      Solid::roundCone(at(0.090f, 0.014f, -0.018f), at(0.042f, -0.040f, 0.050f), 0.024f * s, 0.009f * s),
      0.02f * s);
  cutTop(design, f, cut, hanging, sleeves(f, 0.062f, 0.056f, 0.046f));
  const float head_limit = 0.060f;
  const Field body_opening = design.opening;
  design.opening = [&f, body_opening, hood, head_limit, s](const Vec3& p) {
    // The neckline does not cut the hood, which stands higher than it.
    const float on_hood = hood.distance(toLeft(p)) - 0.004f * s;
    return std::max(std::min(body_opening(p), std::max(on_hood, neckline(f, p, head_limit, 1.0f))),
                    p.y - (f.joints[kNeck].y + 0.09f * s));
  };
  const Field cuffs = [&f, cut, s](const Vec3& p) {
    return std::max(cut.hem_y + 0.045f * s - p.y, sleeveEnd(f, p, cut.sleeve) + 0.045f * s);
  };
  design.shell = [inner = design.shell, hood, cuffs, s](const Vec3& p) {
    const float cloth = smoothMin(inner(p), hood.distance(toLeft(p)), 0.012f * s);
    return cloth + 0.004f * s * smoothStep(-0.003f * s, 0.006f * s, cuffs(p));  // which draw the cloth in
  };
  design.seams = {cuffs};
  design.label = [cuffs](const Vec3& p) { return static_cast<std::uint8_t>(cuffs(p) > 0.0f ? 1 : 0); };
  design.face_count = 1900;
  return design;
}

GarmentDesign designJacket(const Figure& f, const Palette& palette) {
  GarmentDesign design;
  design.name = "cloth.jacket";
  // One name: a tint that replaces the colour makes cloth and lapels alike.
  design.materials = {clothMaterial("cloth.jacket", palette.main),
                      clothMaterial("cloth.jacket", palette.second)};
  const float s = f.scale;
  TopCut cut;
  cut.offset = 0.017f;
  cut.hem_y = hipHeight(f) - (f.isFemale() ? 0.02f : 0.075f) * s;
  cut.neck_rise = 0.004f;
  cut.sleeve = 1.93f;
  SolidGroup hanging = tshirtDrape(f, 0.004f);
  cutTop(design, f, cut, hanging, sleeves(f, 0.058f, 0.052f, 0.041f));
  const float button = f.joints[kSpine1].y + 0.065f * s;
  // Open from the collar to one button, and cut away below it.
  const Field front = [button, s](const Vec3& p) {
    const float up = p.y - button;
    const float half = up > 0.0f ? 0.30f * up : 0.16f * -up - 0.006f * s;
    return std::min(std::min(half, 0.085f * s) - std::abs(p.x), p.z - 0.01f * s);
  };
  const Field lapel = [front, button, s, neck = f.joints[kNeck].y](const Vec3& p) {
    const float up = std::clamp((p.y - button) / (neck - button), 0.0f, 1.0f);
    const float width = 0.048f * s * (up < 0.72f ? up / 0.72f : 1.0f - 0.5f * (up - 0.72f) / 0.28f);
    return std::min(front(p) + width, p.y - button);
  };
  design.shell = [inner = design.shell, lapel, s](const Vec3& p) {
    return inner(p) - 0.0045f * s * smoothStep(-0.004f * s, 0.004f * s, lapel(p));
  };
  design.opening = [inner = design.opening, front](const Vec3& p) { return std::max(inner(p), front(p)); };
  design.seams = {lapel};
  design.label = [lapel](const Vec3& p) { return static_cast<std::uint8_t>(lapel(p) > 0.0f ? 1 : 0); };
  design.face_count = 1900;
  return design;
}

GarmentDesign designDress(const Figure& f, const Palette& palette) {
  GarmentDesign design;
  design.name = "cloth.dress";
  design.materials = {clothMaterial("cloth.dress", palette.main),
                      clothMaterial("cloth.dress.belt", palette.second)};
  const float s = f.scale;
  const float waist = f.joints[kSpine1].y + 0.055f * s, knee = f.joints[kCalf].y;
  const float hem_y = knee - 0.01f * s;
  SolidGroup skirt;
  const auto row = [&](float y, float side, float front, float back) {
    return LoftRow{y, 0, 0, side * s * f.trunk, front * s * f.trunk, back * s * f.trunk};
  };
  const float drop = waist - hem_y;
  skirt.join(Solid::loft({Vec3(0.0f), Mat3(1.0f)}, {row(hem_y - 0.03f * s, 0.275f, 0.215f, 0.225f),
                                                    row(waist - 0.62f * drop, 0.228f, 0.168f, 0.180f),
                                                    row(waist - 0.30f * drop, 0.180f, 0.122f, 0.130f),
                                                    row(waist, 0.124f, 0.088f, 0.080f)}),
             0.0f);
  design.shell = [&f, skirt, s](const Vec3& p) {
    // Straps lie closer than the rest.
    const float offset =
        std::lerp(0.007f, 0.0035f, smoothStep(-0.10f * s, -0.02f * s, p.y - f.joints[kUpperArm].y));
    const float value = smoothMin(f.torso(p), f.neck_solids.distance(p), 0.035f * s) - offset;
    // Folds run down from the waist and grow towards the hem.
    const float fall = smoothStep(0.0f, 0.45f * s, f.joints[kSpine1].y - p.y);
    const float folds = 0.010f * s * fall * std::cos(9.0f * std::atan2(p.x, p.z));
    return smoothMin(value, skirt.distance(p) - folds - 0.004f, 0.02f * s);
  };
  design.opening = [&f, hem_y, s](const Vec3& p) {
    const Vec3 shoulder = f.joints[kUpperArm];
    const float armhole = std::min(
        glm::dot(toLeft(p) - shoulder + Vec3(0.040f * s, 0, 0), glm::normalize(Vec3(1.0f, 0.25f, 0.0f))),
        p.y - (shoulder.y - 0.085f * s));
    const Vec3 scoop =
        (p - Vec3(0.0f, f.joints[kNeck].y + 0.010f * s, 0.055f * s)) / (s * Vec3(0.088f, 0.090f, 0.115f));
    const float scooped = (1.0f - glm::length(scoop)) * 0.088f * s;
    return std::max({hem_y - p.y, armhole, scooped, neckline(f, p, 0.010f, 0.075f)});
  };
  design.binding = [&f](const Vec3& p) { return skirtBinding(f, p, 0.6f); };
  const Field belt = [waist, s](const Vec3& p) { return 0.018f * s - std::abs(p.y - waist); };
  design.shell = [inner = design.shell, belt, s](const Vec3& p) {
    return inner(p) - 0.003f * s * smoothStep(-0.004f * s, 0.004f * s, belt(p));
  };
  design.seams = {belt};
  design.label = [belt](const Vec3& p) { return static_cast<std::uint8_t>(belt(p) > 0.0f ? 1 : 0); };
  design.low = Vec3(-0.45f * s, hem_y - 0.02f, -0.40f * s);
  design.high = Vec3(0.45f * s, f.head_center.y, 0.40f * s);
  design.face_count = 2000;
  design.cover_margin = 0.022f;
  return design;
}

}  // namespace ensemble
