// A garment's fields made into a mesh that moves with the body.
#pragma once

#include <string>
#include <vector>

#include "assetpipe/cloth_design.h"
#include "assetpipe/fit_over_body.h"
#include "core/raw_asset.h"

namespace ensemble {

/// The outside of the cloth, cut at its openings, over the body; labels are 0 for the cloth itself, then its
/// trims in order. Empty where the recipe leaves no cloth on this body.
FieldMesh meshCloth(const TailorFrame& frame, const GarmentRecipe& recipe, const ClothDesign& design);

/// Edges turned in, normals, texture coordinates and weights: one primitive for each label that has faces,
/// `material` the label.
std::vector<RawPrimitive> sewCloth(const TailorFrame& frame, const GarmentRecipe& recipe,
                                   const FieldMesh& mesh);

/// What moves each vertex of a mesh: the body's weights at the nearest skin, evened out along the cloth.
std::vector<SkinBinding> weighCloth(const TailorFrame& frame, const GarmentRecipe& recipe,
                                    const FieldMesh& mesh);

}  // namespace ensemble
