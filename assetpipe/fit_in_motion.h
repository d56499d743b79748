// Cloth lifted where skin would come through it in the template's clips.
#pragma once

#include <vector>

#include "assetpipe/body_motion.h"
#include "assetpipe/field_mesher.h"
#include "core/raw_asset.h"

namespace ensemble {

/// Moves vertices of the cloth outwards, at rest, as far as points of the body that it covers at rest come
/// through the face above them in one of the poses; by kMostLift at most. One round: weights and covers are
/// those at rest.
/// @param skins what moves each vertex of the cloth @return whether anything moved
bool liftInMotion(FieldMesh& cloth, const std::vector<SkinBinding>& skins, const BodySurface& body,
                  const std::vector<PosedBody>& poses);

inline constexpr float kMostLift = 0.008f;  ///< metres, in a round

}  // namespace ensemble
