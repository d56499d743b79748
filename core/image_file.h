// PNG and JPEG, in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/raw_asset.h"

namespace ensemble {

/// 8-bit RGBA, rows from the top, #pixels x 4 bytes; colour is sRGB-encoded, alpha linear.
struct Image8 {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

/// Width and height from the header alone. @throws InputError if it is neither PNG nor JPEG.
void readImageHeader(std::span<const std::byte> bytes, const std::string& file, const std::string& where,
                     RawImage& image);

/// Decodes a PNG or JPEG of any colour type. @throws InputError if it is damaged.
Image8 decodeImage(const RawImage& image, const std::string& file);

/// A PNG of 8-bit RGBA (or RGB when every alpha is 255). The same pixels give the same bytes.
std::vector<std::byte> encodePng(const Image8& image);

}  // namespace ensemble
