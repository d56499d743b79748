#include "assetpipe/people_colors.h"

#include <array>

#include "core/color.h"
#include "core/random.h"

namespace ensemble {
namespace {

constexpr std::array<NamedColor, 6> kSkinTones = {{{"pale", {0.925f, 0.765f, 0.675f}},
                                                   {"fair", {0.880f, 0.690f, 0.580f}},
                                                   {"olive", {0.800f, 0.610f, 0.475f}},
                                                   {"tan", {0.710f, 0.505f, 0.380f}},
                                                   {"brown", {0.540f, 0.365f, 0.265f}},
                                                   {"dark", {0.370f, 0.245f, 0.185f}}}};
constexpr std::array<NamedColor, 6> kHairColors = {{{"black", {0.110f, 0.095f, 0.090f}},
                                                    {"dark-brown", {0.215f, 0.145f, 0.105f}},
                                                    {"brown", {0.340f, 0.225f, 0.150f}},
                                                    {"auburn", {0.430f, 0.195f, 0.105f}},
                                                    {"blond", {0.745f, 0.590f, 0.385f}},
                                                    {"grey", {0.560f, 0.545f, 0.525f}}}};

enum Stream : std::uint64_t { kSkinStream = 1, kHairStream };

}  // namespace

std::span<const NamedColor> skinTones() { return kSkinTones; }
std::span<const NamedColor> hairColors() { return kHairColors; }
Vec3 greyHair() { return kHairColors.back().srgb; }

PersonColors pickColors(std::uint64_t seed) {
  const auto pick = [seed](std::span<const NamedColor> colors, Stream stream) {
    const float at = RandomStream(seed, stream).uniformFloat(0);
    return linearFromSrgb(colors[static_cast<std::size_t>(at * static_cast<float>(colors.size()))].srgb);
  };
  return {pick(kSkinTones, kSkinStream), pick(kHairColors, kHairStream)};
}

}  // namespace ensemble
