// How fast the ground must move under a clip's feet.
#pragma once

#include <string>
#include <vector>

#include "core/clip.h"
#include "core/raw_asset.h"

namespace ensemble {

/// The horizontal speed, metres a second, of a clip played in place: a joint of a foot that stays at
/// its lowest from one key to the next stands on the ground, and the ground moves with it; the
/// median over those intervals. 0 for a clip of one key, and below 0.05 m/s (standing).
float groundSpeed(const RawSkeleton& skeleton, const Clip& clip);

/// Takes out a clip's root motion (root_motion.h) and sets its ground speed: the speed it travelled
/// at, or where that is below 0.05 m/s (an idle clip that drifts, a walk in place) what its feet tell.
/// Appends a warning for a clip that travels in another direction than +Z, by more than 30 degrees,
/// and for one whose feet do not stand on the ground that it travels over.
void putInPlace(const RawSkeleton& skeleton, Clip& clip, std::vector<std::string>& warnings);

}  // namespace ensemble
