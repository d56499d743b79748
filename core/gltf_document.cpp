// glTF 2.0, sections 3.2 (asset), 3.6 (binary data storage), 4.4 (GLB).
#include "core/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "core/atomic_file.h"
#include "core/gltf_uri.h"
#include "core/input_error.h"

namespace ensemble {
namespace {

constexpr std::uint32_t kGlbMagic = 0x46546c67;   // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004e4942;   // "BIN\0"

// Extensions that a file may require of us.
constexpr std::array<std::string_view, 5> kSupported = {
    "KHR_draco_mesh_compression", "KHR_materials_pbrSpecularGlossiness", "KHR_materials_unlit",
    "KHR_mesh_quantization", "KHR_texture_transform"};

std::uint32_t littleEndian32(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(bytes[offset + i]) << (8 * i);
  return value;
}

struct GlbChunks {
  std::string_view json;
  std::span<const std::byte> bin;
};

GlbChunks splitGlb(std::span<const std::byte> bytes, const std::string& file) {
  const auto fail = [&file](std::size_t offset, const std::string& what) {
    throw InputError({file, fmt::format("byte {}", offset), what, kExportAgain});
  };
  if (bytes.size() < 12 || littleEndian32(bytes, 0) != kGlbMagic) fail(0, "this is not a GLB");
  const std::uint32_t version = littleEndian32(bytes, 4);
  if (version != 2) fail(4, fmt::format("GLB version {} instead of 2", version));
  const std::uint32_t length = littleEndian32(bytes, 8);
  if (length != bytes.size()) {
    fail(8, fmt::format("the header promises {} bytes, the file has {}", length, bytes.size()));
  }
  GlbChunks chunks;
  std::size_t offset = 12;
  for (std::size_t number = 0; offset < bytes.size(); ++number) {
    if (bytes.size() - offset < 8) fail(offset, "the file ends inside a chunk's header");
    const std::uint32_t size = littleEndian32(bytes, offset);
    const std::uint32_t type = littleEndian32(bytes, offset + 4);
    if (size > bytes.size() - offset - 8) {
      fail(offset, fmt::format("a chunk of {} bytes reaches beyond the file's end", size));
    }
    if (size % 4 != 0) fail(offset, fmt::format("a chunk's {} bytes are no multiple of 4", size));
    const auto content = bytes.subspan(offset + 8, size);
    if (number == 0 && type != kJsonChunk) fail(offset, "the first chunk is not JSON");
    if (number == 0) chunks.json = {reinterpret_cast<const char*>(content.data()), content.size()};
    if (number == 1 && type == kBinChunk) chunks.bin = content;
    offset += 8 + std::size_t{size};
  }
  if (chunks.json.empty()) fail(12, "the GLB has no JSON");
  return chunks;
}

}  // namespace

GltfDocument GltfDocument::fromGlb(std::span<const std::byte> bytes, const std::string& name,
                                   const std::optional<std::filesystem::path>& folder,
                                   const GltfReadOptions& options) {
  const GlbChunks chunks = splitGlb(bytes, name);
  return GltfDocument(name, folder, options, chunks.json, chunks.bin);
}

GltfDocument GltfDocument::fromText(std::string_view text, const std::string& name,
                                    const std::filesystem::path& folder, const GltfReadOptions& options) {
  return GltfDocument(name, folder, options, text, {});
}

GltfDocument::GltfDocument(std::string name, std::optional<std::filesystem::path> folder,
                           const GltfReadOptions& options, std::string_view text,
                           std::span<const std::byte> bin)
    : file_(std::move(name)),
      folder_(std::move(folder)),
      options_(options),
      json_(parseGltfJson(text, file_, options)) {
  checkVersion();
  checkExtensions();
  loadBuffers(bin);
  checkViews();
}

void GltfDocument::checkVersion() const {
  const JsonRef version = root().require("asset").require("version");
  if (!version.string().starts_with("2.")) {
    version.fail(fmt::format("glTF version {} instead of 2.0", version.string()), "export as glTF 2.0");
  }
}

void GltfDocument::checkExtensions() const {
  for (std::size_t i = 0; i < count("extensionsRequired"); ++i) {
    const JsonRef extension = item("extensionsRequired", i);
    if (std::find(kSupported.begin(), kSupported.end(), extension.string()) == kSupported.end()) {
      extension.fail(fmt::format("the file requires extension '{}'", extension.string()),
                     "export without this extension");
    }
  }
}

std::size_t GltfDocument::count(std::string_view array) const {
  const auto found = root().find(array);
  return found ? found->size() : 0;
}

JsonRef GltfDocument::item(std::string_view array, std::size_t index) const {
  return root().require(array)[index];
}

std::uint32_t GltfDocument::index(const JsonRef& value, std::string_view array) const {
  const std::size_t size = count(array);
  const std::uint64_t index = value.wholeNumber(0xffffffffu);
  if (index >= size) value.fail(fmt::format("there is no '{}' number {}", array, index));
  return static_cast<std::uint32_t>(index);
}

std::optional<std::uint32_t> GltfDocument::findIndex(const JsonRef& owner, std::string_view key,
                                                     std::string_view array) const {
  const auto value = owner.find(key);
  if (!value) return std::nullopt;
  return index(*value, array);
}

std::vector<std::byte> GltfDocument::loadUri(const JsonRef& uri) const {
  const std::uint64_t budget = options_.max_file_bytes - loaded_bytes_;
  auto bytes = decodeDataUri(uri, budget);
  if (!bytes) {
    if (!folder_) uri.fail("a file in memory can't name other files", "pack everything into the GLB");
    const std::filesystem::path file = resolveUri(uri, *folder_);
    if (std::filesystem::file_size(file) > budget) {
      uri.fail(fmt::format("the files named add up to more than {} bytes", options_.max_file_bytes),
               "split the file");
    }
    bytes = readFile(file, budget);
  }
  loaded_bytes_ += bytes->size();
  return *std::move(bytes);
}

std::vector<std::byte> GltfDocument::copyView(const JsonRef& owner, std::uint32_t index) const {
  const auto bytes = views_[index].bytes;
  if (bytes.size() > options_.max_file_bytes - loaded_bytes_) {
    owner.fail(fmt::format("the images add up to more than {} bytes", options_.max_file_bytes),
               "split the file");
  }
  loaded_bytes_ += bytes.size();
  return {bytes.begin(), bytes.end()};
}

void GltfDocument::loadBuffers(std::span<const std::byte> bin) {
  const std::size_t buffer_count = count("buffers");
  for (std::size_t i = 0; i < buffer_count; ++i) {
    const JsonRef buffer = item("buffers", i);
    const std::uint64_t length = buffer.require("byteLength").wholeNumber(options_.max_file_bytes);
    std::span<const std::byte> bytes;
    if (const auto uri = buffer.find("uri")) {
      loaded_.push_back(loadUri(*uri));
      bytes = loaded_.back();
    } else if (i == 0) {
      bytes = bin;
    } else {
      buffer.fail("the buffer has no data");
    }
    if (length > bytes.size()) {
      buffer.fail(fmt::format("the buffer promises {} bytes and has {}", length, bytes.size()));
    }
    buffers_.push_back(bytes.first(length));
  }
}

void GltfDocument::checkViews() {
  const std::size_t view_count = count("bufferViews");
  for (std::size_t i = 0; i < view_count; ++i) {
    const JsonRef view = item("bufferViews", i);
    const auto buffer = buffers_[index(view.require("buffer"), "buffers")];
    const std::uint64_t offset = view.wholeNumberOr("byteOffset", 0, 1ull << 53);
    const std::uint64_t length = view.require("byteLength").wholeNumber(1ull << 53);
    if (offset > buffer.size() || length > buffer.size() - offset) {
      view.fail(
          fmt::format("bytes {} to {} reach beyond the buffer's {}", offset, offset + length, buffer.size()));
    }
    const std::uint64_t stride = view.wholeNumberOr("byteStride", 0, 252);
    if (view.has("byteStride") && (stride < 4 || stride % 4 != 0)) {
      view.fail(fmt::format("byteStride {} is no multiple of 4 from 4 to 252", stride));
    }
    views_.push_back({buffer.subspan(offset, length), static_cast<std::uint32_t>(stride)});
  }
}

}  // namespace ensemble
