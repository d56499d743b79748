// How people move: clips authored from a figure's measures.
#pragma once

#include <vector>

#include "assetpipe/people_figure.h"
#include "core/clip.h"

namespace ensemble {

/// The speed of a figure's walk over the ground, metres a second.
float walkSpeed(const Figure& figure);

/// `walk`: 1.1 s in place, 34 keys at 30 Hz; the feet stand still on a ground that moves backwards at
/// walkSpeed. Phase 0 is the left heel's strike.
Clip makeWalkClip(const Figure& figure, const RawSkeleton& skeleton);

/// `idle`: 4 s standing, 121 keys at 30 Hz: breathing, weight shifted from leg to leg.
Clip makeIdleClip(const Figure& figure, const RawSkeleton& skeleton);

}  // namespace ensemble
