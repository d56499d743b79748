// Levels of detail as collapses of vertices onto neighbours, with no new vertices: P. Dong and C. Peng,
// section 4 (the order of collapses as an array). Level 0 shows all; a vertex is there up to the level that
// lacks it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/raw_asset.h"

namespace ensemble {

/// How many levels a mesh has: 1 where nothing collapses.
std::uint32_t levelCount(std::span<const VertexCollapse> collapses);

/// Whether a level shows a vertex where it is.
inline bool isShownAt(const VertexCollapse& collapse, std::uint32_t level) {
  return collapse.level == 0 || level < collapse.level;
}

inline constexpr std::uint32_t kGone = 0xffffffffu;

/// The vertex that stands for each at a level, #V; kGone where none does, as its faces have all gone.
/// @pre areValid(collapses)
std::vector<std::uint32_t> verticesAtLevel(std::span<const VertexCollapse> collapses, std::uint32_t level);

/// The faces that are left at a level, in the order given: those whose corners are in three places.
/// @param shown of verticesAtLevel @param position_of tells the place of a vertex, to compare
template <class PositionOf>
std::vector<Triangle> facesAtLevel(std::span<const Triangle> faces, std::span<const std::uint32_t> shown,
                                   const PositionOf& position_of) {
  std::vector<Triangle> left;
  for (const Triangle& face : faces) {
    const Triangle moved = {shown[face[0]], shown[face[1]], shown[face[2]]};
    if (moved[0] == kGone || moved[1] == kGone || moved[2] == kGone) continue;
    const auto &a = position_of(moved[0]), &b = position_of(moved[1]), &c = position_of(moved[2]);
    if (a != b && b != c && c != a) left.push_back(moved);
  }
  return left;
}

/// Whether each target, where it is another vertex, outlasts the level at which others move onto it:
/// following targets ends, and all vertices of a level may go in any order.
bool areValid(std::span<const VertexCollapse> collapses);

}  // namespace ensemble
