// `ensemble author`: a recipe on a template becomes an outfit file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "assetpipe/author_body.h"
#include "assetpipe/fit_over_body.h"
#include "assetpipe/recipe.h"
#include "core/raw_asset.h"

namespace ensemble {

/// What is told of a garment.
struct GarmentFigures {
  std::string name;
  std::size_t faces = 0, vertices = 0;
  float least_distance = 0.0f, mean_distance = 0.0f,
        greatest_distance = 0.0f;  ///< of its outside to the skin
  Pokes pokes;                     ///< by more than kPokeTolerance
};
inline constexpr float kPokeTolerance = 0.0005f;  ///< metres

struct AuthoredOutfit {
  RawAsset asset;  ///< the template without its clips, and a node `garment.NAME` for each garment
  std::vector<GarmentFigures> garments;
  std::vector<std::string> warnings;  ///< of garments that still cross the body
};

/// Dresses a template. The template's meshes are kept as they are, so that the outfit matches it; slot and
/// layer stand in the scene's `extras`. The same recipe and template give the same outfit.
/// @param asset, body the template as it was read and as it was segmented
/// @throws InputError in the recipe's file: joints or regions that the template lacks, a garment of which
/// this body leaves nothing, a texture that can't be read
AuthoredOutfit authorOutfit(const Recipe& recipe, const RawAsset& asset, const AuthorBody& body);

}  // namespace ensemble
