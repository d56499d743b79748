// Fuzzes parseRecipe: hostile text is refused with a UserError or read; what was read is within the ranges
// that docs/authoring.md promises to the code behind.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "assetpipe/recipe.h"
#include "core/input_error.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void checkProfile(const ensemble::Profile& profile) {
  require(!profile.points.empty());
  for (const auto& [place, length] : profile.points) {
    require(std::abs(place) <= 3.0f);
    require(length >= 0.0009f && length <= 0.1201f);
  }
}

void checkRanges(const ensemble::Recipe& recipe) {
  require(!recipe.name.empty() && std::abs(recipe.layer) <= 1000);
  require(!recipe.garments.empty());
  for (const ensemble::GarmentRecipe& garment : recipe.garments) {
    require(garment.triangles >= 100 && garment.triangles <= 20000);
    require(garment.thickness > 0.0f && garment.thickness <= 0.0201f);
    require(garment.trims.size() <= 100);
    checkProfile(garment.ease);
    checkProfile(garment.sleeve_ease);
    checkProfile(garment.leg_ease);
    for (const float level : {garment.hem, garment.top.value_or(0.0f)}) require(std::abs(level) <= 3.0f);
    for (const ensemble::Interval& strap : garment.straps) require(strap.from < strap.to && strap.to <= 1.0f);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ensemble::Recipe recipe;
  try {
    recipe = ensemble::parseRecipe(std::string(reinterpret_cast<const char*>(data), size), "fuzz.yaml");
  } catch (const ensemble::UserError&) {
    return -1;
  }
  checkRanges(recipe);
  return 0;
}
