// Vertices made sound: weights, normals, welding (design 2). Private to gltf_file.h's
// implementation.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/raw_asset.h"

namespace ensemble {

/// The four largest of a vertex's influences (joint, weight), descending, equal weights in the given
/// order, several of one joint added up, normalised; weights of 0 are ignored.
/// Idempotent. All zero gives a binding of zero weights.
SkinBinding settleBinding(std::span<const std::pair<std::uint32_t, float>> influences);

/// Normalises normals that are off by more than noise, and makes those that are missing (0): the mean
/// of the faces around the position, weighted by area; +Y where these are of zero area.
void settleNormals(RawMeshNode& mesh);

/// Gives all vertices of one position the binding of the first of them, so that the surface can't
/// tear. Returns how many vertices were weighted differently by more than noise (1e-3).
std::size_t unifyWedges(RawMeshNode& mesh);

/// Makes vertices one that are equal in everything (0 == -0) and removes those that no face uses; the
/// first of equal ones stays, in the old order. Faces keep their order.
void weld(RawPrimitive& primitive);

}  // namespace ensemble
