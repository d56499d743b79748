// Tones of skin and hair that people have.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "assetpipe/people_skin.h"

namespace ensemble {

/// Tones that a configuration may name, and those that a seed picks.
struct NamedColor {
  std::string_view name;
  Vec3 srgb;
};
std::span<const NamedColor> skinTones();
std::span<const NamedColor> hairColors();
Vec3 greyHair();  ///< the one among them that old people have, sRGB
PersonColors pickColors(std::uint64_t seed);

}  // namespace ensemble
