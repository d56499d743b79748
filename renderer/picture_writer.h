// Pictures as files: PNG for colour, OpenEXR for linear colour and numbers. Each file is there whole or
// not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/image_file.h"
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
/// by alpha, as in Picture::linear. @throws SystemError if the file can't be written.
void writeLinearPicture(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height,
                        std::span<const std::uint16_t> rgba);

/// 8-bit sRGB. @throws SystemError if the file can't be written.
void writePicture(const std::filesystem::path& file, const Image8& image);

/// character, region, face: the UINT channel `id`, from 32-bit numbers, #pixels.
/// @throws SystemError if the file can't be written. @pre the kind is one of these three.
void writeIdAov(const std::filesystem::path& file, Aov aov, std::uint32_t width, std::uint32_t height,
                std::span<const std::uint32_t> ids);

/// depth: the FLOAT channel `Z`, #pixels; normal: `N.X`, `N.Y`, `N.Z`, #pixels x 3.
/// @throws SystemError if the file can't be written. @pre the kind is one of these two.
void writeFloatAov(const std::filesystem::path& file, Aov aov, std::uint32_t width, std::uint32_t height,
                   std::span<const float> values);

}  // namespace ensemble
