// From a recipe and a measured body to fields: the outside of the cloth, its openings and trims.
#pragma once

#include <string>
#include <vector>

#include "assetpipe/recipe.h"
#include "assetpipe/tailor_frame.h"

namespace ensemble {

/// An edge of the cloth: negative where there is cloth, metres to the edge.
struct ClothEdge {
  std::string name;  ///< as trims call it
  Field cut;
  bool is_opening = true;  ///< false: only trims refer to it
};

struct ClothTrim {
  Field inside;  ///< positive in the trim, metres
  float raise = 0.0f;
};

/// A garment before it is meshed. Its fields refer to the frame, which must outlive it.
struct ClothDesign {
  Field shell;    ///< the outside of the cloth, openings closed
  Field opening;  ///< the largest of the openings in `edges`
  std::vector<ClothEdge> edges;
  std::vector<ClothTrim> trims;  ///< as the recipe's; the last one that holds a point wins
  Vec3 low{0.0f}, high{0.0f};    ///< box that holds it
  float cell = 0.006f;           ///< of the grid it is meshed on, metres
};

/// @pre the landmarks of the recipe's kind are there (requiredLandmarks)
ClothDesign designCloth(const TailorFrame& frame, const GarmentRecipe& recipe);

std::vector<Landmark> requiredLandmarks(const GarmentRecipe& recipe);

/// The three kinds; without trims, regions to avoid and cuts by solids, which designCloth adds.
ClothDesign designBodyCloth(const TailorFrame& frame, const GarmentRecipe& recipe);
ClothDesign designShoes(const TailorFrame& frame, const GarmentRecipe& recipe);
ClothDesign designHeadwear(const TailorFrame& frame, const GarmentRecipe& recipe);

/// The solids of a recipe joined; 1e3 everywhere where there are none.
Field joinedSolids(const TailorFrame& frame, const std::vector<SolidRecipe>& solids);

}  // namespace ensemble
