// How a person's tint seed colours skin, hair, shoes and cloth.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/math.h"

namespace ensemble {

enum class TintKind : std::uint8_t { kNone, kSkin, kHair, kShoes, kCloth };

/// What a material is, from its name and whether it belongs to the body. A path of names parted by
/// dots or colons is read by its first words: "hair.bob02", "cloth.shoes01". "fixed.", eyes, teeth,
/// tongue, nails and lashes keep their colour; brows go with the hair.
TintKind tintKindOf(std::string_view material_name, bool is_body);

/// The colours of a kind, in `tintTable()`.
struct TintRange {
  std::uint32_t first = 0, count = 0;
  std::uint32_t lower_count = 0;   ///< of these, for trousers under a shirt; 0: parts are not told apart
  float strength = 0.0f;           ///< how far a tint replaces a plain material's colour, 0 .. 1
  float textured_strength = 0.0f;  ///< the same under a texture, which has colours of its own
  float spread = 0.0f;             ///< brightness varies by +- this part
  float sheen = 0.0f;
};
TintRange tintRange(TintKind kind);

/// All tints, linear RGB with w = 1.
const std::vector<Vec4>& tintTable();

/// A number for a name, the same on every machine: what a tint seed is hashed with. Body materials
/// of one kind share theirs, so that a person's skin is one colour.
std::uint32_t tintKey(TintKind kind, std::string_view garment_name);

}  // namespace ensemble
