#include "renderer/debug_overlay.h"

#include <algorithm>
#include <bit>

#include "core/check.h"

namespace ensemble {
namespace {

constexpr OverlayColor kPipeline{235, 130, 20}, kCompute{40, 110, 235};
constexpr OverlayColor kExactPose{225, 40, 40};
/// Neighbouring keys of a clip differ.
constexpr std::array<OverlayColor, 6> kKeys = {
    {{40, 110, 235}, {30, 190, 150}, {120, 80, 220}, {60, 200, 60}, {30, 170, 230}, {160, 150, 240}}};
/// 1, 2, 3 to 4, 5 to 8, ..., 65 and more.
constexpr std::array<OverlayColor, 8> kOverdraw = {{{68, 1, 84},
                                                    {65, 68, 135},
                                                    {42, 120, 142},
                                                    {34, 168, 132},
                                                    {122, 209, 81},
                                                    {253, 231, 37},
                                                    {250, 150, 20},
                                                    {220, 30, 20}}};

}  // namespace

OverlayColor colorOfRasteriser(bool is_computed) { return is_computed ? kCompute : kPipeline; }

OverlayColor colorOfPose(std::uint32_t key) {
  return key == ViewPeople::kExact ? kExactPose : kKeys[key % kKeys.size()];
}

OverlayColor colorOfOverdraw(std::uint32_t count) {
  ENSEMBLE_CHECK(count > 0u);
  return kOverdraw[std::min<std::size_t>(static_cast<std::size_t>(std::bit_width(count - 1u)),
                                         kOverdraw.size() - 1)];
}

void showOverdraw(std::span<const std::uint32_t> counts, Image8& picture) {
  for (std::size_t i = 0; i < counts.size(); ++i) {
    std::uint8_t* const rgb = picture.rgba.data() + 4 * i;
    const auto grey = static_cast<std::uint8_t>(luma(rgb) / 2);
    const OverlayColor color = counts[i] > 0 ? colorOfOverdraw(counts[i]) : OverlayColor{grey, grey, grey};
    std::copy(color.begin(), color.end(), rgb);
  }
}

}  // namespace ensemble
