// How fast the ground must move under a clip's feet.
#pragma once

#include <vector>

#include "core/clip.h"
#include "core/raw_asset.h"

namespace ensemble {

/// The horizontal speed, metres a second, of a clip played in place: in every interval between two
/// keys the lowest vertices stand on the ground, and the ground moves with them; the median over
/// the intervals in which feet touch it. 0 for a clip of one key, and below 0.05 m/s (standing).
float groundSpeed(const RawSkeleton& skeleton, const std::vector<RawVertex>& vertices, const Clip& clip);

}  // namespace ensemble
