// Whether triangles make a sound solid, by CGAL's predicates, which are exact. The one place that uses CGAL.
#pragma once

#include <span>
#include <vector>

#include "core/raw_asset.h"

namespace ensemble {

struct SurfaceCheck {
  bool is_manifold = false;     ///< edges have one or two faces that run the same way, vertices one fan
  bool is_closed = false;       ///< every edge has two faces
  bool faces_outwards = false;  ///< its volume is positive; false where it is not closed
  /// Where faces cut each other beyond a shared edge or corner: the middle of one face of each pair.
  std::vector<Vec3> crossings;
  bool isSound() const { return is_manifold && is_closed && faces_outwards && crossings.empty(); }
};

/// Checks faces over positions that are already welded: neighbours share indices. A surface that is no
/// manifold, or empty, is not looked at further. @pre indices are in range, positions are finite
SurfaceCheck checkSurface(std::span<const Vec3> positions, std::span<const Triangle> faces);

}  // namespace ensemble
