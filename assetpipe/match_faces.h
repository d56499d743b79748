// Matches the faces of a body embedded in an outfit with the template's, one to one (design 3).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ids.h"
#include "core/math.h"
#include "core/wardrobe.h"

namespace ensemble {

/// A face of the embedded body.
struct EmbeddedFace {
  static constexpr std::uint32_t kAnyMaterial = 0xffffffffu;
  std::array<Vec3, 3> corners;            ///< metres, model space, in winding order
  std::uint32_t material = kAnyMaterial;  ///< index into TemplateBody::materials
};

struct FaceMatches {
  std::vector<FaceId> template_face;  ///< per embedded face; none() where it matches no face
  std::uint32_t unmatched = 0;
  /// How far the embedded body's corners are from the template's nearest positions, metres.
  float median_distance = 0.0f, max_distance = 0.0f;
};

/// Two faces can match if they have the same material and winding and each corner of one lies
/// within `tolerance` metres of the other's. Nearest pairs first; then as many pairs as possible
/// (augmenting paths), so that faces smaller than the tolerance don't take each other's place.
/// Order and numbering don't matter, and the same input gives the same pairs.
FaceMatches matchFaces(const TemplateBody& body, std::span<const EmbeddedFace> embedded, float tolerance);

}  // namespace ensemble
