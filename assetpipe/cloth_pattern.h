// Patterns of cloth as small textures.
#pragma once

#include "assetpipe/recipe.h"
#include "core/raw_asset.h"

namespace ensemble {

/// One repeat of a pattern as a PNG, which fits to itself on all sides. @pre pattern.kind is not kNone
RawImage patternImage(const std::string& name, const Vec3& srgb, const Pattern& pattern);

}  // namespace ensemble
