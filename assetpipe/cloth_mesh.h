// A garment's fields made into a mesh that moves with the body.
#pragma once

#include <span>
#include <vector>

#include "assetpipe/cloth_design.h"
#include "assetpipe/fit_over_body.h"
#include "core/raw_asset.h"

namespace ensemble {

/// The outside of a garment's cloth, and what moves it.
struct ClothPiece {
  FieldMesh mesh;                  ///< labels: 0 for the cloth itself, then its trims in order
  std::vector<SkinBinding> skins;  ///< #V
};

/// The outside of the cloth, cut at its openings, over the body and the garments below, at rest and in the
/// template's clips. Empty where the recipe leaves no cloth on this body.
ClothPiece meshCloth(const TailorFrame& frame, const GarmentRecipe& recipe, const ClothDesign& design,
                     std::span<const ClothPiece> below);

/// Edges turned in, normals, texture coordinates and weights: one primitive for each label that has faces,
/// `material` the label.
std::vector<RawPrimitive> sewCloth(const TailorFrame& frame, const GarmentRecipe& recipe,
                                   const ClothPiece& cloth);

/// What moves each vertex of a mesh: the body's weights at the nearest skin, evened out along the cloth.
std::vector<SkinBinding> weighCloth(const TailorFrame& frame, const GarmentRecipe& recipe,
                                    const FieldMesh& mesh);

}  // namespace ensemble
