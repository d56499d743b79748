// The pose pass on the host: where a person's joints are, for annotations and tests.
#pragma once

#include <span>
#include <vector>

#include "core/wardrobe.h"
#include "renderer/crowd.h"

namespace ensemble {

/// A pose as it is shown from afar: at the nearest key frame of the clip that weighs more (KeyFrames).
CharacterPose atNearestKey(const TemplateBody& body, CharacterPose pose);

/// What skins a vertex, #joints, model space: the same arithmetic as shaders/pose.comp (key frames
/// interpolated as matrices, the idle clip blended in, legs bent to hold the feet).
std::vector<Mat4> posedMatrices(const TemplateBody& body, const CharacterPose& pose);

/// Where the joints are in the world, #joints, metres.
/// @param matrices posedMatrices(body, pose)
std::vector<Vec3> jointPositions(const TemplateBody& body, const CharacterPose& pose,
                                 std::span<const Mat4> matrices);
std::vector<Vec3> posedJoints(const TemplateBody& body, const CharacterPose& pose);

}  // namespace ensemble
