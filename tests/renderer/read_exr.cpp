#include "tests/renderer/read_exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <cstring>
#include <stdexcept>

#include "core/atomic_file.h"

namespace ensemble::testing_support {
namespace {

class MemoryStream : public Imf::IStream {
 public:
  explicit MemoryStream(std::span<const std::byte> bytes) : Imf::IStream("memory"), bytes_(bytes) {}

  bool read(char target[], int count) override {
    const auto wanted = static_cast<std::size_t>(count);
    if (wanted > bytes_.size() - at_) throw std::runtime_error("the file ends too early");
    std::memcpy(target, bytes_.data() + at_, wanted);
    at_ += wanted;
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override {
    if (position > bytes_.size()) throw std::runtime_error("the file ends too early");
    at_ = static_cast<std::size_t>(position);
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};

template <class T>
void addSlice(Imf::FrameBuffer& buffer, const char* name, Imf::PixelType type, std::vector<T>& values,
              const ExrPicture& picture) {
  values.resize(std::size_t{picture.width} * picture.height);
  buffer.insert(
      name, Imf::Slice(type, reinterpret_cast<char*>(values.data()), sizeof(T), sizeof(T) * picture.width));
}

}  // namespace

ExrPicture readExr(std::span<const std::byte> bytes) {
  MemoryStream stream(bytes);
  Imf::InputFile file(stream, 0);
  const auto window = file.header().dataWindow();
  ExrPicture picture;
  picture.width = static_cast<std::uint32_t>(window.max.x - window.min.x + 1);
  picture.height = static_cast<std::uint32_t>(window.max.y - window.min.y + 1);
  picture.is_zip = file.header().compression() == Imf::ZIP_COMPRESSION;
  if (Imf::hasChromaticities(file.header())) {
    const Imf::Chromaticities& found = Imf::chromaticities(file.header());
    picture.says_rec709 = found.red == Imath::V2f(0.64f, 0.33f) && found.green == Imath::V2f(0.3f, 0.6f) &&
                          found.blue == Imath::V2f(0.15f, 0.06f) &&
                          found.white == Imath::V2f(0.3127f, 0.329f);
  }
  Imf::FrameBuffer buffer;
  const Imf::ChannelList& channels = file.header().channels();
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    const Imf::PixelType type = channel.channel().type;
    if (type == Imf::UINT) {
      addSlice(buffer, channel.name(), type, picture.uint_channels[channel.name()], picture);
    } else if (type == Imf::FLOAT) {
      addSlice(buffer, channel.name(), type, picture.float_channels[channel.name()], picture);
    } else {
      addSlice(buffer, channel.name(), type, picture.half_channels[channel.name()], picture);
    }
  }
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  return picture;
}

ExrPicture readExr(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = readFile(file);
  return readExr(bytes);
}

}  // namespace ensemble::testing_support
