// OpenEXR files read back, for tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace ensemble::testing_support {

/// A picture's channels, rows from the top.
struct ExrPicture {
  std::uint32_t width = 0, height = 0;
  bool is_zip = false;
  bool says_rec709 = false;  ///< chromaticities are there, and those of Rec. 709
  std::map<std::string, std::vector<std::uint32_t>> uint_channels;
  std::map<std::string, std::vector<float>> float_channels;
  std::map<std::string, std::vector<std::uint16_t>> half_channels;  ///< bits
};

/// @throws std::exception (OpenEXR's) for what is no such file
ExrPicture readExr(std::span<const std::byte> bytes);
ExrPicture readExr(const std::filesystem::path& file);

}  // namespace ensemble::testing_support
