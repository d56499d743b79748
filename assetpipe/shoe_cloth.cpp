// Shoes: the foot offset outwards, on a sole cut from its outline.
#include <algorithm>
#include <cmath>

#include "assetpipe/cloth_design.h"

namespace ensemble {

ClothDesign designShoes(const TailorFrame& frame, const GarmentRecipe& recipe) {
  const float s = frame.scale(), ground = frame.body().ground();
  const SoleRecipe& sole = recipe.sole;
  ClothDesign design;
  const auto soleAt = [&frame, sole, s, ground](const Vec3& p) {
    const float heel = sole.heel * (1.0f - smoothStep(0.30f, 0.42f, frame.footPlace(p)));
    const float low = ground - (sole.thickness + heel) * s, high = ground + sole.rise * s;
    const float slab = std::abs(p.y - 0.5f * (low + high)) - 0.5f * (high - low);
    return smoothMax(frame.footprint(p) - sole.out * s, slab, 0.006f * s);
  };
  design.shell = [&frame, &recipe, s, ground, soleAt,
                  solids = joinedSolids(frame, recipe.solids)](const Vec3& p) {
    const float above = (p.y - ground) / std::max(recipe.height * s, 1e-4f);
    const float skin = frame.body().distance(p);
    const float upper = smoothMax(skin - recipe.ease.at(above) * s, ground - p.y, 0.004f * s);
    return std::min({upper, soleAt(p), solids(p)});
  };
  const Vec3 ankle = frame.marks().at(Landmark::kAnkle);
  const float top = ground + recipe.height * s, slope = recipe.slope;
  design.edges.push_back(
      {"top", [top, slope, ankle](const Vec3& p) { return p.y - top + slope * (p.z - ankle.z); }});
  if (!recipe.straps.empty()) {
    design.edges.push_back({"edge", [&frame, straps = recipe.straps, length = frame.footLength(),
                                     over = ground + sole.rise * s](const Vec3& p) {
                              const float place = frame.footPlace(p);
                              float outside = 1.0f;
                              for (const Interval& strap : straps) {
                                outside = std::min(outside, std::max(strap.from - place, place - strap.to));
                              }
                              return std::min(outside * length, p.y - over - 0.001f);
                            }});
  }
  const auto sole_edge = [high = ground + sole.rise * s](const Vec3& p) { return high - 0.001f - p.y; };
  design.edges.push_back({"sole", sole_edge, false});
  design.low = frame.body().low() - 0.1f * s;
  design.high = frame.body().high() + 0.1f * s;
  design.low.y = ground - (sole.thickness + sole.heel + 0.02f) * s;
  design.high.y = top + (std::abs(slope) * 0.2f + 0.02f) * s;
  design.cell = 0.0042f * s;
  return design;
}

}  // namespace ensemble
