// Hats and hair: shells around the skull, cut along a brim's edge or the hairline.
#include <algorithm>
#include <cmath>
#include <memory>

#include "assetpipe/cloth_design.h"

namespace ensemble {
namespace {

/// Positive in front of the hairline, from the forehead past the temples to the sideburns; the reference
/// head's measures.
float hairline(const Vec3& h, const HairRecipe& hair) {
  const float side = std::max(std::abs(h.x) - 0.015f, 0.0f);
  // A curve on the forehead: highest in the middle, down along the temples to the ears.
  const float height = hair.front - 9.0f * side * side;
  const float forehead = smoothMin(height - h.y, h.z - 0.020f, 0.02f);
  const float temple = h.z - 0.026f - 0.12f * h.y;
  const float below_sideburn = std::min(hair.sideburn - h.y, h.z + 0.002f);
  return std::max(std::min(forehead, temple), below_sideburn);
}

/// Positive below the line behind the ear down to the nape.
float napeLine(const Vec3& h, const HairRecipe& hair) {
  return std::min(hair.nape + 0.62f * std::max(h.z + 0.085f, 0.0f), -0.006f) - h.y;
}

/// Positive where hair that falls in front of the ears leaves the face free.
float curtainLine(const Vec3& h, const HairRecipe& hair) {
  const float side = std::abs(h.x);
  const float face =
      h.z - (0.032f + 0.70f * std::max(h.y - 0.020f, 0.0f)) - 0.12f * std::max(0.05f - side, 0.0f);
  const float forehead = std::min(hair.front - h.y, h.z - 0.020f);
  const float throat = h.y < -0.02f ? std::min(h.z + 0.030f, 0.055f - side) : -1.0f;
  const float tips = -hair.length - h.y + 0.25f * std::max(h.z, 0.0f);
  return std::max({std::min(face, std::max(forehead, h.z - 0.05f)), throat, tips});
}

/// Grooves as combed hair has them, metres of the reference head.
float grooves(const Vec3& h, float depth) {
  const float around = std::atan2(h.x, -h.z + 0.02f);
  return depth *
         (0.6f * std::sin(26.0f * around + 14.0f * h.y) + 0.4f * std::sin(43.0f * around - 21.0f * h.y));
}

/// The skull without ears and nose, and the curtain of long hair, in the head's place.
std::shared_ptr<SolidGroup> headSolids(const TailorFrame& frame, const GarmentRecipe& recipe) {
  auto group = std::make_shared<SolidGroup>();
  const Vec3 scale = frame.headScales();
  group->join(
      Solid::ellipsoid(frame.fromHead({0.0f, 0.008f, -0.011f}), Vec3(0.0775f, 0.0925f, 0.0975f) * scale),
      0.0f);
  if (recipe.hair && recipe.hair->curtain) {
    const auto row = [&](float y, float z, float side, float front, float back) {
      return LoftRow{y * scale.y, 0, z * scale.z, side * scale.x, front * scale.z, back * scale.z};
    };
    const float length = recipe.hair->length, longer = std::max(length - 0.10f, 0.0f);
    const LoftFrame at{frame.fromHead(Vec3(0.0f)), Mat3(1.0f)};
    group->join(
        Solid::loft(at,
                    {row(-length - 0.032f, -0.022f - 0.20f * longer, 0.074f, 0.040f, 0.054f + 0.85f * longer),
                     row(-0.88f * length, -0.016f - 0.12f * longer, 0.088f, 0.052f, 0.074f + 0.72f * longer),
                     row(-0.42f * length, -0.012f, 0.088f, 0.056f, 0.090f + 0.40f * longer),
                     row(0.005f, -0.010f, 0.083f, 0.060f, 0.094f)}),
        0.03f * frame.headScale());
  }
  return group;
}

}  // namespace

ClothDesign designHeadwear(const TailorFrame& frame, const GarmentRecipe& recipe) {
  const float size = frame.headScale();
  const float ease = recipe.ease.at(2.0f) * size, strands = recipe.strands;
  const auto solid = headSolids(frame, recipe);
  const Field added = joinedSolids(frame, recipe.solids);
  ClothDesign design;
  // Hair and hats alone, without the skin that they must clear.
  const Field worn = [&frame, solid, added, ease, strands, size](const Vec3& p) {
    const Vec3 h = frame.onHead(p);
    float value = solid->distance(p) - ease;
    if (strands > 0.0f) value -= size * grooves(h, strands) * smoothStep(0.090f, 0.050f, h.y);
    return smoothMin(value, added(p), 0.006f * size);
  };
  const float clearance = std::min(ease, 0.004f * size);
  design.shell = [&frame, worn, clearance, size](const Vec3& p) {
    return smoothMin(worn(p), frame.body().distance(p) - clearance, 0.006f * size);
  };
  // Skin that stands out far from the hair is no scalp: shoulders under long hair, ears.
  design.edges.push_back({"", [&frame, worn, size](const Vec3& p) {
                            const float low = smoothStep(-0.050f, -0.095f, frame.onHead(p).y);
                            return worn(p) - size * glm::mix(0.022f, 0.008f, low);
                          }});
  if (recipe.hair) {
    design.edges.push_back({"edge", [&frame, hair = *recipe.hair, added, size](const Vec3& p) {
                              const Vec3 h = frame.onHead(p);
                              const float line = hair.curtain
                                                     ? curtainLine(h, hair)
                                                     : std::max(hairline(h, hair), napeLine(h, hair));
                              return std::min(size * line, added(p) - 0.008f * size);
                            }});
  } else {
    design.edges.push_back(
        {"edge", [&frame, edge = recipe.edge, slope = recipe.edge_slope, added, size](const Vec3& p) {
           const Vec3 h = frame.onHead(p);
           return std::min(size * (edge + slope * h.z - h.y), added(p) - 0.002f * size);
         }});
  }
  const float length = recipe.hair && recipe.hair->curtain ? recipe.hair->length + 0.05f : 0.22f;
  design.low = frame.fromHead(Vec3(-0.24f, -std::max(length, 0.30f), -0.30f));
  design.high = frame.fromHead(Vec3(0.24f, 0.30f, 0.30f));
  design.cell = 0.0045f * size;
  return design;
}

}  // namespace ensemble
