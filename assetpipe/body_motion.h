// A template's body in poses of its clips: what cloth must stay outside of when people move.
#pragma once

#include <vector>

#include "assetpipe/body_surface.h"
#include "core/wardrobe.h"

namespace ensemble {

/// A body in one pose.
struct PosedBody {
  std::vector<Mat4> skinning_matrices;  ///< #joints
  std::vector<Vec3> positions;          ///< of the surface's vertices, #V
};

/// Poses evenly over the time of each clip of the template; none where it has no clips.
std::vector<PosedBody> poseInClips(const TemplateBody& body, const BodySurface& surface);

/// How far a point stands off the posed skin's face at the place below it, along its normal; metres.
float heightOver(const PosedBody& posed, const BodySurface& surface, const NearestPoint& below,
                 const Vec3& point);

}  // namespace ensemble
