// Which clothes go together, and in which colours.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "assetpipe/people_garments.h"
#include "assetpipe/people_skin.h"

namespace ensemble {

/// Linear colour of an sRGB one, each 0 .. 1.
Vec3 linearFromSrgb(const Vec3& srgb);

/// Tones that a configuration may name, and those that a seed picks.
struct NamedColor {
  std::string_view name;
  Vec3 srgb;
};
std::span<const NamedColor> skinTones();
std::span<const NamedColor> hairColors();
Vec3 greyHair();  ///< the one among them that old people have, sRGB
PersonColors pickColors(std::uint64_t seed);

/// An outfit as the names of its garments, in the order of the file's nodes.
struct OutfitPlan {
  std::string name;
  std::vector<std::string> garments;
};
std::vector<OutfitPlan> outfitPlans(Sex sex);

/// A garment of a plan by its name, in colours picked by `seed`. @pre `name` is in a plan.
GarmentDesign designGarment(const Figure& figure, const PersonColors& colors, std::uint64_t seed,
                            std::string_view name);

}  // namespace ensemble
