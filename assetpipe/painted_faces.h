// Faces of an outfit's body that its artist painted: hidden or kept, whatever rays find (docs/wardrobe.md).
#pragma once

#include <cstdint>

#include "core/raw_asset.h"

namespace ensemble {

/// What the attribute `_HIDE` says of a face.
enum class Paint : std::uint8_t { kNone, kHide, kKeep };

/// kHide where all three corners have more than 0.5, kKeep where all have less than -0.5.
Paint paintOf(const RawPrimitive& primitive, const Triangle& face);

}  // namespace ensemble
