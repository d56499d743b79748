#include "renderer/picture_writer.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <cstring>
#include <exception>

#include "core/check.h"
#include "core/input_error.h"

namespace ensemble {
namespace {

/// OpenEXR's idea of a file, in memory: it seeks back to fill in the table of scan lines.
class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : Imf::OStream("picture in memory") {}

  void write(const char bytes[], int count) override {
    const std::size_t end = at_ + static_cast<std::size_t>(count);
    if (bytes_.size() < end) bytes_.resize(end);
    std::memcpy(bytes_.data() + at_, bytes, static_cast<std::size_t>(count));
    at_ = end;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t position) override { at_ = static_cast<std::size_t>(position); }

  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
  std::size_t at_ = 0;
};

template <class T>
Imf::Slice makeSlice(Imf::PixelType type, std::span<const T> values, std::size_t stride, std::size_t width) {
  const std::size_t x_stride = stride * sizeof(T);
  // OpenEXR takes one pointer for reading and writing; an OutputFile only reads.
  char* const base = const_cast<char*>(reinterpret_cast<const char*>(values.data()));
  return Imf::Slice(type, base, x_stride, x_stride * width);
}

/// @pre the channel has a value for each pixel
Imf::Slice sliceOf(const ExrChannel& channel, std::size_t width, std::size_t pixel_count) {
  ENSEMBLE_CHECK(channel.stride > 0u);
  const std::size_t needed = (pixel_count - 1) * channel.stride + 1;
  if (const auto* const ids = std::get_if<std::span<const std::uint32_t>>(&channel.values)) {
    ENSEMBLE_CHECK(ids->size() >= needed);
    return makeSlice(Imf::UINT, *ids, channel.stride, width);
  }
  if (const auto* const halves = std::get_if<std::span<const std::uint16_t>>(&channel.values)) {
    ENSEMBLE_CHECK(halves->size() >= needed);
    return makeSlice(Imf::HALF, *halves, channel.stride, width);
  }
  const auto& floats = std::get<std::span<const float>>(channel.values);
  ENSEMBLE_CHECK(floats.size() >= needed);
  return makeSlice(Imf::FLOAT, floats, channel.stride, width);
}

std::vector<std::byte> encodeChannels(std::uint32_t width, std::uint32_t height, const Imf::Header& header,
                                      const Imf::FrameBuffer& buffer) {
  try {
    MemoryStream stream;
    {
      constexpr int kNoThreads = 0;  // frames are written side by side; one picture needs no more
      Imf::OutputFile file(stream, header, kNoThreads);
      file.setFrameBuffer(buffer);
      file.writePixels(static_cast<int>(height));
    }
    return stream.take();
  } catch (const std::exception& error) {
    throw SystemError({"", "",
                       "OpenEXR can't encode " + std::to_string(width) + " x " + std::to_string(height) +
                           " pixels: " + error.what(),
                       ""});
  }
}

}  // namespace

std::vector<std::byte> encodeExr(std::uint32_t width, std::uint32_t height,
                                 std::span<const ExrChannel> channels, ExrContent content) {
  constexpr std::uint32_t kMaxSide = 16384;
  ENSEMBLE_CHECK(width >= 1u && width <= kMaxSide);
  ENSEMBLE_CHECK(height >= 1u && height <= kMaxSide);
  ENSEMBLE_CHECK(!channels.empty());
  Imf::Header header(static_cast<int>(width), static_cast<int>(height));
  header.compression() = Imf::ZIP_COMPRESSION;
  if (content == ExrContent::kRec709Light) Imf::addChromaticities(header, Imf::Chromaticities());
  Imf::FrameBuffer buffer;
  for (const ExrChannel& channel : channels) {
    ENSEMBLE_CHECK(header.channels().findChannel(channel.name) == nullptr);
    const Imf::Slice slice = sliceOf(channel, width, std::size_t{width} * height);
    header.channels().insert(channel.name, Imf::Channel(slice.type));
    buffer.insert(channel.name, slice);
  }
  return encodeChannels(width, height, header, buffer);
}

std::span<const char* const> exrChannelsOf(Aov aov) {
  static constexpr const char* kId[] = {"id"};
  static constexpr const char* kDepth[] = {"Z"};
  static constexpr const char* kNormal[] = {"N.X", "N.Y", "N.Z"};
  if (aov == Aov::kDepth) return kDepth;
  if (aov == Aov::kNormal) return kNormal;
  return kId;
}

std::span<const char* const> exrChannelsOfLight() {
  static constexpr const char* kLight[] = {"A", "B", "G", "R"};
  return kLight;
}

std::vector<std::byte> encodeLinearPicture(std::uint32_t width, std::uint32_t height,
                                           std::span<const std::uint16_t> rgba) {
  ENSEMBLE_CHECK(rgba.size() == std::size_t{4} * width * height);
  const ExrChannel channels[] = {
      {"R", rgba, 4}, {"G", rgba.subspan(1), 4}, {"B", rgba.subspan(2), 4}, {"A", rgba.subspan(3), 4}};
  return encodeExr(width, height, channels, ExrContent::kRec709Light);
}

std::vector<std::byte> encodeIdAov(Aov aov, std::uint32_t width, std::uint32_t height,
                                   std::span<const std::uint32_t> ids) {
  ENSEMBLE_CHECK(aov == Aov::kCharacter || aov == Aov::kRegion || aov == Aov::kFace);
  ENSEMBLE_CHECK(ids.size() == std::size_t{width} * height);
  const ExrChannel channels[] = {{"id", ids}};
  return encodeExr(width, height, channels);
}

std::vector<std::byte> encodeFloatAov(Aov aov, std::uint32_t width, std::uint32_t height,
                                      std::span<const float> values) {
  const std::size_t pixel_count = std::size_t{width} * height;
  if (aov == Aov::kDepth) {
    ENSEMBLE_CHECK(values.size() == pixel_count);
    const ExrChannel channels[] = {{"Z", values}};
    return encodeExr(width, height, channels);
  }
  ENSEMBLE_CHECK(aov == Aov::kNormal);
  ENSEMBLE_CHECK(values.size() == 3 * pixel_count);
  const ExrChannel channels[] = {
      {"N.X", values, 3}, {"N.Y", values.subspan(1), 3}, {"N.Z", values.subspan(2), 3}};
  return encodeExr(width, height, channels);
}

}  // namespace ensemble
