// The skin: the body's surface cut into six regions, and the weights that bind it to the joints.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "assetpipe/field_mesher.h"
#include "assetpipe/people_figure.h"

namespace ensemble {

/// The regions, in the order of their primitives in every file.
enum class BodyRegion : std::uint8_t { kHead, kHands, kFeet, kArms, kTorso, kLegs };
inline constexpr std::size_t kBodyRegionCount = 6;
inline constexpr std::array<const char*, kBodyRegionCount> kBodyRegionNames = {"head", "hands", "feet",
                                                                               "arms", "torso", "legs"};

/// Borders between regions: positive on the side of the named region. They run where clothes end:
/// at the neck's base, the upper arm below the shoulder, the wrist, along the groin, above the ankle.
float headBorder(const Figure& figure, const Vec3& p);
float armBorder(const Figure& figure, const Vec3& p);
float handBorder(const Figure& figure, const Vec3& p);
float legBorder(const Figure& figure, const Vec3& p);
float footBorder(const Figure& figure, const Vec3& p);

/// Positive inside a neckline: above a plane that falls to the front, `rise` over the neck's base, and
/// within `radius` of the neck's axis; both in metres of the reference figure.
float neckline(const Figure& figure, const Vec3& p, float rise, float radius);

BodyRegion bodyRegion(const Figure& figure, const Vec3& p);

/// The body's surface, closed, about `face_count` faces (even), labels are BodyRegion. No face cuts another
/// unless `face_count` is too small for that: check with checkSurface.
FieldMesh makeBodyMesh(const Figure& figure, std::size_t face_count);

/// Which joints move a point of the body; a smooth function of the position. Weights descend and sum to 1.
SkinBinding bodyBinding(const Figure& figure, const Vec3& p);

/// A vertex with the normal of `field` (outward), texture coordinates from the front, and `skin`.
RawVertex makeVertex(const Figure& figure, const Field& field, const Vec3& position, const SkinBinding& skin);

}  // namespace ensemble
