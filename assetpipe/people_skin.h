// What is painted on the head: eyes, brows, lips, cropped hair.
#pragma once

#include "assetpipe/people_figure.h"
#include "core/raw_asset.h"

namespace ensemble {

/// Linear colours of a person's skin and hair.
struct PersonColors {
  Vec3 skin{0.60f, 0.36f, 0.26f};
  Vec3 hair{0.06f, 0.03f, 0.02f};
};

/// Texture coordinates on the head: around it (u = 0.5 in front, the seam behind) and down (v). A point on
/// the seam has two; `right` picks the one of the right half.
Vec2 headUv(const Figure& figure, const Vec3& position, bool right);

/// The head's texture, a PNG of 512 x 512; its colours are absolute, most of it is plain skin. The same
/// figure and colours give the same bytes.
RawImage paintHead(const Figure& figure, const PersonColors& colors);

}  // namespace ensemble
