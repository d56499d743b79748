// Shoes: the foot offset outwards, on a sole cut from its footprint.
#include <algorithm>
#include <cmath>

#include "assetpipe/people_garments.h"

namespace ensemble {
namespace {

struct ShoeCut {
  float offset = 0.006f;                         // metres off the skin
  float shaft_y = 0.085f;                        // height of the shaft, metres
  float shaft_slope = 0.0f;                      // how much it falls to the front, metres a metre
  float sole_low = -0.014f, sole_high = 0.012f;  // metres
  float sole_out = 0.008f;                       // how far the sole stands out, metres
  float heel = 0.0f;                             // height of a heel over the sole, metres
};

void cutShoe(GarmentDesign& design, const Figure& f, const ShoeCut& cut) {
  const float s = f.scale;
  const auto sole = [&f, cut, s](const Vec3& p) {
    // The footprint, seen a little above the ground, drawn down to the sole's underside.
    const float print = f.foot({p.x, 0.016f * s, p.z}) - cut.sole_out * s;
    const float middle = 0.5f * (cut.sole_low + cut.sole_high) * s,
                half = 0.5f * (cut.sole_high - cut.sole_low) * s;
    return smoothMax(print, std::abs(p.y - middle) - half, 0.010f * s);
  };
  design.shell = [&f, cut, s, sole](const Vec3& p) {
    const float foot = smoothMin(f.foot(p), f.leg(p), 0.018f * s) - cut.offset * s;
    const float upper = smoothMax(foot, -p.y, 0.004f * s);
    return std::min(upper, sole(p));
  };
  const Vec3 ankle = f.joints[kFoot];
  design.opening = [cut, s, ankle](const Vec3& p) {
    return p.y - cut.shaft_y * s + cut.shaft_slope * (p.z - ankle.z);
  };
  const Field sole_edge = [cut, s](const Vec3& p) { return cut.sole_high * s - 0.001f - p.y; };
  design.seams = {sole_edge};
  design.label = [sole_edge](const Vec3& p) {
    return static_cast<std::uint8_t>(sole_edge(p) > 0.0f ? 1 : 0);
  };
  design.binding = [&f](const Vec3& p) { return bodyBinding(f, p); };
  // The sole's edges stay crisp.
  design.importance = [cut, s](const Vec3& p) { return p.y < (cut.sole_high + 0.004f) * s ? 5.0f : 1.0f; };
  design.low = Vec3(-0.25f * s, -0.03f * s, -0.16f * s);
  design.high = Vec3(0.25f * s, 0.20f * s, 0.26f * s);
  design.cell = 0.0032f;
  design.hem = 0.005f;
  design.cover_margin = 0.012f;
  design.face_count = 900;
}

}  // namespace

GarmentDesign designSneakers(const Figure& f, const Palette& palette) {
  GarmentDesign design;
  design.name = "shoes.sneakers";
  design.materials = {clothMaterial("shoes.sneakers", palette.main),
                      clothMaterial("shoes.sneakers.sole", palette.second)};
  ShoeCut cut;
  cut.offset = 0.008f;
  cut.shaft_y = 0.088f;
  cut.shaft_slope = 0.10f;
  cut.sole_high = 0.015f;
  cutShoe(design, f, cut);
  return design;
}

GarmentDesign designOxfords(const Figure& f, const Palette& palette) {
  GarmentDesign design;
  design.name = "shoes.oxfords";
  design.materials = {clothMaterial("shoes.oxfords", palette.main),
                      clothMaterial("shoes.oxfords.sole", palette.second)};
  ShoeCut cut;
  cut.offset = 0.008f;
  cut.shaft_y = 0.082f;
  cut.shaft_slope = 0.05f;
  cut.sole_high = 0.006f;
  cut.sole_out = 0.007f;
  cutShoe(design, f, cut);
  return design;
}

GarmentDesign designFlats(const Figure& f, const Palette& palette) {
  GarmentDesign design;
  design.name = "shoes.flats";
  design.materials = {clothMaterial("shoes.flats", palette.main),
                      clothMaterial("shoes.flats.sole", palette.second)};
  ShoeCut cut;
  cut.offset = 0.004f;
  cut.shaft_y = 0.046f;
  cut.shaft_slope = 0.14f;
  cut.sole_high = 0.004f;
  cut.sole_low = -0.010f;
  cut.sole_out = 0.005f;
  cutShoe(design, f, cut);
  // Cut low over the instep.
  design.opening = [inner = design.opening, &f](const Vec3& p) {
    const float s = f.scale;
    const Vec3 left(std::abs(p.x), p.y, p.z);
    const Vec3 from =
        (left - (f.joints[kFoot] + Vec3(0.006f, -0.020f, 0.075f) * s)) / (s * Vec3(0.031f, 0.045f, 0.072f));
    return std::max(inner(p), (1.0f - glm::length(from)) * 0.031f * s);
  };
  return design;
}

}  // namespace ensemble
