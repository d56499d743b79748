// Where a crowd's people stand and which way they look.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math.h"
#include "core/scene.h"

namespace ensemble {

/// A place in the crowd.
struct Place {
  Vec3 position{0.0f};   ///< metres, world
  float heading = 0.0f;  ///< radians about +Y, 0 looks along +Z; 0 .. 2 pi where it is random
};

/// `count` places. No two are nearer than `placement.spacing` (grid and formation with jitter:
/// spacing x (1 - 2 jitter)), as far as 32-bit positions can tell. O(count) time and memory.
///
/// grid: rows along X, as square as possible or of `columns`, centred as a whole, the last row
/// filled from -X. formation: ranks side by side to `heading`, the first in front, the last centred.
/// disc: blue noise, a maximal Poisson-disc sample of which the `count` places nearest to the
/// centre are kept, numbered from the centre outwards. table: everybody at the centre, which what the
/// table says is added to.
///
/// @pre spacing > 0, 0 <= jitter <= 0.45. @throws std::length_error when a disc can't hold `count`
/// places that far from the origin, because positions are too coarse there.
std::vector<Place> placePeople(const ScenePlacement& placement, std::uint32_t count, std::uint64_t seed);

}  // namespace ensemble
