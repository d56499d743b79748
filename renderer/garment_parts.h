// The pieces of a garment that is one mesh: a suit is a shirt and trousers, and may be tinted so.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shaders/shared/vertex.h"

namespace ensemble {

/// Parts that are told apart; the lowest of more share the last number.
inline constexpr std::uint32_t kMostGarmentParts = 8;

/// Per vertex its part, from the top down. Connected components (over equal positions) are one part
/// where they share half the height of the lower one or more: two sleeves, a belt on trousers.
/// Vertices that no face uses are of part 0.
/// @param vertices in model space, +Y up @param indices three per face, valid
std::vector<std::uint8_t> garmentParts(std::span<const GpuVertex> vertices,
                                       std::span<const std::uint32_t> indices);

}  // namespace ensemble
