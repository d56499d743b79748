// A tile's pixels, from the buffers that the device filled into the picture on the host.
#pragma once

#include "renderer/view.h"
#include "renderer/view_targets.h"

namespace ensemble {

/// Colours, sRGB and, where the view asks for them, linear.
void readColor(const ViewTargets& targets, const View& view, Picture& picture);
/// The AOVs that the view asks for; the others become empty.
void readAovs(const ViewTargets& targets, const View& view, Picture& picture);

}  // namespace ensemble
