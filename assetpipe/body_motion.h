// A template's body in poses of its clips: what cloth must stay outside of when people move.
#pragma once

#include <span>
#include <vector>

#include "assetpipe/body_surface.h"
#include "core/wardrobe.h"

namespace ensemble {

/// A body in one pose.
struct PosedBody {
  std::vector<Mat4> skinning_matrices;  ///< #joints
  std::vector<Vec3> positions;          ///< of the surface's vertices, #V
};

/// Skinning matrices, #joints, of poses evenly over the time of each clip of the template; none where it has
/// no clips.
std::vector<std::vector<Mat4>> matricesInClips(const TemplateBody& body);

/// The surface in these poses.
std::vector<PosedBody> poseInClips(const TemplateBody& body, const BodySurface& surface);

/// A mesh's vertices in one pose. @param skins what moves each @return as many
std::vector<Vec3> posedPositions(std::span<const Vec3> positions, std::span<const SkinBinding> skins,
                                 std::span<const Mat4> skinning_matrices);

/// How far a point stands off the posed skin's face at the place below it, along its normal; metres.
float heightOver(const PosedBody& posed, const BodySurface& surface, const NearestPoint& below,
                 const Vec3& point);

}  // namespace ensemble
