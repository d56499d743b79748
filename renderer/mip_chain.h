// A texture's levels, filtered in linear light.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image_file.h"
#include "core/math.h"

namespace ensemble {

/// Levels of an RGBA8 texture from `side` x `side` texels down to 1 x 1. The image is brought to
/// that size first: area averages where it shrinks, bilinear where it grows. Colours are averaged in
/// linear light, weighted by alpha, so that no cut-out border bleeds in.
/// @pre side is a power of two, the image is not empty
std::vector<std::vector<std::uint8_t>> mipChain(const Image8& image, std::uint32_t side);

/// The mean colour of an image's opaque parts, linear; mid grey where there are none.
Vec3 meanColor(const Image8& image);

}  // namespace ensemble
