#include "assetpipe/people_outfits.h"

#include <array>
#include <cmath>

#include "core/check.h"
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

/// sRGB colours for a garment: each row goes together.
struct Colorway {
  Vec3 main, second;
};

using Design = GarmentDesign (*)(const Figure&, const Palette&);

struct GarmentEntry {
  std::string_view name;
  Design design;
  std::array<Colorway, 3> colorways;
};

constexpr Vec3 kWhite{0.93f, 0.92f, 0.90f}, kBlack{0.10f, 0.10f, 0.11f}, kLeather{0.30f, 0.19f, 0.12f};

const std::array<GarmentEntry, 15> kGarments = {{
    {"tshirt",
     designTshirt,
     {{{{0.80f, 0.29f, 0.24f}, {0.70f, 0.24f, 0.20f}},
       {{0.93f, 0.90f, 0.84f}, {0.86f, 0.82f, 0.75f}},
       {{0.24f, 0.48f, 0.47f}, {0.19f, 0.40f, 0.40f}}}}},
    {"shirt",
     designShirt,
     {{{kWhite, {0.48f, 0.12f, 0.15f}},
       {{0.76f, 0.84f, 0.92f}, {0.13f, 0.18f, 0.33f}},
       {{0.90f, 0.86f, 0.89f}, {0.30f, 0.16f, 0.33f}}}}},
    {"blouse",
     designBlouse,
     {{{{0.94f, 0.92f, 0.87f}, kWhite}, {{0.86f, 0.66f, 0.64f}, kWhite}, {{0.68f, 0.80f, 0.82f}, kWhite}}}},
    {"hoodie",
     designHoodie,
     {{{{0.86f, 0.63f, 0.25f}, {0.78f, 0.55f, 0.20f}},
       {{0.34f, 0.45f, 0.36f}, {0.28f, 0.38f, 0.30f}},
       {{0.56f, 0.57f, 0.60f}, {0.47f, 0.48f, 0.51f}}}}},
    {"jacket",
     designJacket,
     {{{{0.18f, 0.21f, 0.31f}, {0.15f, 0.17f, 0.26f}},
       {{0.33f, 0.33f, 0.35f}, {0.28f, 0.28f, 0.30f}},
       {{0.45f, 0.35f, 0.27f}, {0.38f, 0.29f, 0.22f}}}}},
    {"dress",
     designDress,
     {{{{0.72f, 0.22f, 0.31f}, {0.34f, 0.10f, 0.15f}},
       {{0.20f, 0.42f, 0.55f}, {0.90f, 0.86f, 0.78f}},
       {{0.91f, 0.75f, 0.34f}, {0.45f, 0.30f, 0.16f}}}}},
    {"jeans",
     designJeans,
     {{{{0.23f, 0.33f, 0.50f}, {0.17f, 0.25f, 0.39f}},
       {{0.36f, 0.47f, 0.62f}, {0.29f, 0.39f, 0.53f}},
       {{0.16f, 0.19f, 0.27f}, kLeather}}}},
    {"trousers",
     designTrousers,
     {{{{0.18f, 0.21f, 0.31f}, kLeather},
       {{0.30f, 0.30f, 0.32f}, kBlack},
       {{0.40f, 0.31f, 0.24f}, kLeather}}}},
    {"shorts",
     designShorts,
     {{{{0.22f, 0.25f, 0.31f}, kWhite},
       {{0.62f, 0.54f, 0.41f}, {0.55f, 0.47f, 0.35f}},
       {{0.27f, 0.36f, 0.52f}, kWhite}}}},
    {"leggings",
     designLeggings,
     {{{{0.15f, 0.15f, 0.18f}, {0.80f, 0.36f, 0.42f}},
       {{0.22f, 0.27f, 0.38f}, {0.42f, 0.66f, 0.72f}},
       {{0.33f, 0.17f, 0.30f}, {0.75f, 0.50f, 0.66f}}}}},
    {"skirt",
     designSkirt,
     {{{{0.20f, 0.21f, 0.25f}, kWhite}, {{0.35f, 0.28f, 0.24f}, kWhite}, {{0.17f, 0.22f, 0.34f}, kWhite}}}},
    {"sneakers",
     designSneakers,
     {{{kWhite, {0.80f, 0.80f, 0.78f}}, {{0.76f, 0.27f, 0.24f}, kWhite}, {{0.22f, 0.25f, 0.32f}, kWhite}}}},
    {"oxfords",
     designOxfords,
     {{{kBlack, {0.06f, 0.06f, 0.06f}},
       {{0.36f, 0.21f, 0.13f}, {0.13f, 0.08f, 0.06f}},
       {{0.24f, 0.13f, 0.10f}, {0.08f, 0.05f, 0.05f}}}}},
    {"flats",
     designFlats,
     {{{{0.55f, 0.12f, 0.16f}, kBlack}, {kBlack, {0.06f, 0.06f, 0.06f}}, {{0.62f, 0.45f, 0.32f}, kLeather}}}},
    {"cap",
     designCap,
     {{{{0.20f, 0.28f, 0.45f}, {0.16f, 0.22f, 0.37f}},
       {{0.70f, 0.22f, 0.20f}, {0.58f, 0.17f, 0.16f}},
       {{0.25f, 0.27f, 0.26f}, {0.85f, 0.62f, 0.25f}}}}},
}};

struct HairEntry {
  std::string_view name;
  Design design;
};
const std::array<HairEntry, 4> kHair = {{{"hair.short", designShortHair},
                                         {"hair.bob", designBob},
                                         {"hair.bun", designBun},
                                         {"hair.ponytail", designPonytail}}};

enum Stream : std::uint64_t { kSkinStream = 1, kHairStream, kGarmentStream };

}  // namespace

Vec3 linearFromSrgb(const Vec3& srgb) {
  Vec3 linear;
  for (int i = 0; i < 3; ++i) {
    linear[i] = srgb[i] <= 0.04045f ? srgb[i] / 12.92f : std::pow((srgb[i] + 0.055f) / 1.055f, 2.4f);
  }
  return linear;
}

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

std::vector<OutfitPlan> outfitPlans(Sex sex) {
  if (sex == Sex::kFemale) {
    return {{"casual", {"tshirt", "jeans", "sneakers", "hair.ponytail"}},
            {"summer", {"dress", "flats", "hair.bob"}},
            {"office", {"jacket", "blouse", "skirt", "flats", "hair.bun"}},
            {"sport", {"hoodie", "leggings", "sneakers", "hair.ponytail"}}};
  }
  return {{"casual", {"tshirt", "jeans", "sneakers", "hair.short"}},
          {"suit", {"jacket", "shirt", "trousers", "oxfords", "hair.short"}},
          {"sport", {"hoodie", "shorts", "sneakers", "hair.short", "cap"}},
          {"weekend", {"hoodie", "jeans", "sneakers", "hair.short"}}};
}

GarmentDesign designGarment(const Figure& figure, const PersonColors& colors, std::uint64_t seed,
                            std::string_view name) {
  for (const HairEntry& hair : kHair) {
    if (hair.name == name) return hair.design(figure, {colors.hair, Vec3(0.35f, 0.05f, 0.06f)});
  }
  for (std::size_t i = 0; i < kGarments.size(); ++i) {
    const GarmentEntry& garment = kGarments[i];
    if (garment.name != name) continue;
    // Jacket and trousers make a suit: they pick the same row.
    const std::uint64_t index = name == "trousers" || name == "jacket" || name == "skirt" ? 0 : i + 1;
    const std::size_t row = RandomStream(seed, kGarmentStream).bits32(index) % garment.colorways.size();
    const Colorway& colorway = garment.colorways[row];
    return garment.design(figure, {linearFromSrgb(colorway.main), linearFromSrgb(colorway.second)});
  }
  ENSEMBLE_CHECK(!"a garment of a plan");
  return {};
}

}  // namespace ensemble
