// How people move: clips authored from a figure's measures. All are in place and loop: the last key equals
// the first.
#pragma once

#include <vector>

#include "assetpipe/people_figure.h"
#include "core/clip.h"

namespace ensemble {

/// The speed of a figure's walk and run over the ground, metres a second.
float walkSpeed(const Figure& figure);
float runSpeed(const Figure& figure);

/// `walk`: 1.1 s, 34 keys at 30 Hz; the feet stand still on a ground that moves backwards at walkSpeed.
/// Phase 0 is the left heel's strike.
Clip makeWalkClip(const Figure& figure, const RawSkeleton& skeleton);

/// `run`: 0.7 s, 43 keys at 60 Hz (limbs are fast), likewise at runSpeed; both feet leave the ground.
Clip makeRunClip(const Figure& figure, const RawSkeleton& skeleton);

/// `idle`: 4 s standing, 121 keys at 30 Hz: breathing, weight shifted from leg to leg.
Clip makeIdleClip(const Figure& figure, const RawSkeleton& skeleton);

/// `talk`: 6 s standing, 181 keys: hands that stress what is said, a head that nods and looks about.
Clip makeTalkClip(const Figure& figure, const RawSkeleton& skeleton);

/// `cheer`: 1.6 s, 49 keys: both arms thrown up, bouncing in the knees.
Clip makeCheerClip(const Figure& figure, const RawSkeleton& skeleton);

/// All of them, walk first.
std::vector<Clip> makeClips(const Figure& figure, const RawSkeleton& skeleton);

}  // namespace ensemble
