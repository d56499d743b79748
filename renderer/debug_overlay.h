// Pictures that tell how they were drawn (`debug` of a scene): colours laid over a finished picture, by who
// shows at each pixel. What draws pictures knows nothing of it. docs/performance.md has the colours'
// meanings. No Vulkan.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/image_file.h"
#include "renderer/view_people.h"

namespace ensemble {

using OverlayColor = std::array<std::uint8_t, 3>;  // sRGB

OverlayColor colorOfRasteriser(bool is_computed);
/// @param key as ViewPeople::key: those of the same key have the same colour, kExact one that no key has
OverlayColor colorOfPose(std::uint32_t key);
/// How often triangles covered a pixel, by powers of two. @pre count > 0
OverlayColor colorOfOverdraw(std::uint32_t count);

/// Tints each person of a picture and takes the colour from everything else.
/// @param character per pixel: 0, nobody; else 1 + number
template <class ColorOf>
void tintPeople(std::span<const std::uint32_t> character, const ColorOf& color_of, Image8& picture);

/// Shows how often triangles of people covered each pixel; where none did, the picture without colour,
/// darker.
/// @param counts per pixel
void showOverdraw(std::span<const std::uint32_t> counts, Image8& picture);

/// A pixel's brightness, 0 .. 255, as sRGB has it.
inline int luma(const std::uint8_t* rgb) { return (54 * rgb[0] + 183 * rgb[1] + 19 * rgb[2] + 128) >> 8; }

template <class ColorOf>
void tintPeople(std::span<const std::uint32_t> character, const ColorOf& color_of, Image8& picture) {
  for (std::size_t i = 0; i < character.size(); ++i) {
    std::uint8_t* const rgb = picture.rgba.data() + 4 * i;
    const int grey = luma(rgb);
    const bool is_person = character[i] != 0;
    const OverlayColor color = is_person ? color_of(character[i] - 1) : OverlayColor{};
    // Two parts of the tint to one of the picture, so that shapes still show.
    for (std::size_t k = 0; k < 3; ++k)
      rgb[k] = static_cast<std::uint8_t>(is_person ? (2 * color[k] + grey) / 3 : grey);
  }
}

}  // namespace ensemble
