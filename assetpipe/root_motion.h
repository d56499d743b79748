// Clips that travel, put in place: what the figure covers over the ground becomes a speed.
#pragma once

#include "core/clip.h"
#include "core/raw_asset.h"

namespace ensemble {

/// Takes the net horizontal travel of the figure's hips out of a clip, the same part in each
/// interval, so that they end above where they began; what else they do stays, as does their height.
/// The clip keeps its heading: one that walks sideways or backwards still looks where it looked.
/// What is moved is the highest bone that carries the travel (a root joint, or the hips under a
/// root that stands still), and bones beside it that travel along (targets of inverse kinematics).
/// A travel under 0.1 mm changes nothing.
/// @returns the velocity that was taken out, metres a second along X and Z; 0 for a clip of one key
Vec2 takeOutRootMotion(const RawSkeleton& skeleton, Clip& clip);

}  // namespace ensemble
