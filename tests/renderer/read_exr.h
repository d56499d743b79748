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

/// A picture of UINT and FLOAT channels, rows from the top.
struct ExrPicture {
  std::uint32_t width = 0, height = 0;
  bool is_zip = false;
  std::map<std::string, std::vector<std::uint32_t>> uint_channels;
  std::map<std::string, std::vector<float>> float_channels;
};

/// @throws std::exception (OpenEXR's) for what is no such file
ExrPicture readExr(std::span<const std::byte> bytes);
ExrPicture readExr(const std::filesystem::path& file);

}  // namespace ensemble::testing_support
