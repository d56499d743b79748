// How fast the ground must move under a clip's feet.
#pragma once

#include "core/clip.h"
#include "core/raw_asset.h"

namespace ensemble {

/// The horizontal speed, metres a second, of a clip played in place: a joint of a foot that stays at
/// its lowest from one key to the next stands on the ground, and the ground moves with it; the
/// median over those intervals. 0 for a clip of one key, and below 0.05 m/s (standing).
float groundSpeed(const RawSkeleton& skeleton, const Clip& clip);

}  // namespace ensemble
