// The animation texture (design 9).
#pragma once

#include "renderer/animation.h"
#include "renderer/vk/memory.h"

namespace ensemble {

/// Rows of ENSEMBLE_ANIMATION_WIDTH texels, RGBA32F, ready to be sampled.
/// @throws SystemError with the sizes if the device's images are too small for it.
gpu::Image uploadAnimation(gpu::Device& device, const Animation& animation);

}  // namespace ensemble
