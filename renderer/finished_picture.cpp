#include "renderer/finished_picture.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>

#include <algorithm>
#include <array>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

namespace ensemble {
namespace {

using namespace std::string_literals;

constexpr std::size_t kPngHead = 24;  // signature, and the first chunk's length, name, width and height
const std::string kPngStart = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR"s;
const std::string kPngEnd = "\0\0\0\0IEND\xae\x42\x60\x82"s;

std::string bigEndian(std::uint32_t value) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 0xffu);
  return bytes;
}

bool hasChannels(const Imf::ChannelList& list, std::span<const char* const> channels) {
  std::vector<std::string> names;
  for (auto channel = list.begin(); channel != list.end(); ++channel) names.emplace_back(channel.name());
  return std::equal(names.begin(), names.end(), channels.begin(), channels.end());
}

}  // namespace

bool isFinishedPng(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(kPngHead, '\0'), end(kPngEnd.size(), '\0');
  if (!stream.read(head.data(), static_cast<std::streamsize>(head.size()))) return false;
  if (head != kPngStart + bigEndian(width) + bigEndian(height)) return false;
  stream.seekg(-static_cast<std::streamoff>(end.size()), std::ios::end);
  return stream.read(end.data(), static_cast<std::streamsize>(end.size())) && end == kPngEnd;
}

bool isFinishedExr(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height,
                   std::span<const char* const> channels) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return false;
  try {
    Imf::InputFile input(file.c_str(), 0);
    const auto window = input.header().dataWindow();
    if (window.min.x != 0 || window.min.y != 0 || window.max.x + 1 != static_cast<int>(width) ||
        window.max.y + 1 != static_cast<int>(height) || !input.isComplete() ||
        !hasChannels(input.header().channels(), channels)) {
      return false;
    }
    // The last line's block is the file's end: a file that was cut off can't give it.
    std::vector<std::uint32_t> line(width);
    Imf::FrameBuffer buffer;
    buffer.insert(channels.front(),
                  Imf::Slice(input.header().channels()[channels.front()].type,
                             reinterpret_cast<char*>(line.data()), sizeof(std::uint32_t), 0));
    input.setFrameBuffer(buffer);
    input.readPixels(window.max.y);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace ensemble
