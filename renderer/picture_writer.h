// Pictures as the bytes of OpenEXR files: linear colour and numbers. (PNG: core/image_file.h.)
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "renderer/frame_names.h"

namespace ensemble {

/// One channel of a picture: a value per pixel, rows from the top, `stride` values apart (so that
/// the three of a vector can be given without copying them).
struct ExrChannel {
  std::string name;
  /// UINT, FLOAT, or HALF as its 16 bits.
  std::variant<std::span<const std::uint32_t>, std::span<const float>, std::span<const std::uint16_t>> values;
  std::size_t stride = 1;
};

/// What the channels are: numbers, or light, whose primaries and white (those of Rec. 709 and sRGB) the
/// file then names.
enum class ExrContent : std::uint8_t { kNumbers, kRec709Light };

/// A single-part OpenEXR file in memory: scan lines, ZIP. The same values give the same bytes.
/// @pre width and height are 1 .. 16384; every channel has a value for each pixel; names differ.
/// @throws SystemError if OpenEXR refuses.
std::vector<std::byte> encodeExr(std::uint32_t width, std::uint32_t height,
                                 std::span<const ExrChannel> channels,
                                 ExrContent content = ExrContent::kNumbers);

/// Names of the channels that the functions below write.
std::span<const char* const> exrChannelsOf(Aov aov);
std::span<const char* const> exrChannelsOfLight();  ///< A, B, G, R

/// Linear light, the HALF channels R, G, B, A: half-precision bits of RGBA, #pixels x 4, colour multiplied
/// by alpha, as in Picture::linear. @throws SystemError if OpenEXR refuses; so do those below.
std::vector<std::byte> encodeLinearPicture(std::uint32_t width, std::uint32_t height,
                                           std::span<const std::uint16_t> rgba);

/// character, region, face: the UINT channel `id`, from 32-bit numbers, #pixels.
/// @pre the kind is one of these three.
std::vector<std::byte> encodeIdAov(Aov aov, std::uint32_t width, std::uint32_t height,
                                   std::span<const std::uint32_t> ids);

/// depth: the FLOAT channel `Z`, #pixels; normal: `N.X`, `N.Y`, `N.Z`, #pixels x 3.
/// @pre the kind is one of these two.
std::vector<std::byte> encodeFloatAov(Aov aov, std::uint32_t width, std::uint32_t height,
                                      std::span<const float> values);

}  // namespace ensemble
