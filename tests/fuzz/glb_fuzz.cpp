// Fuzzes readGlb: hostile bytes are refused with a UserError or read, never more; what was read can
// be written, and read again.
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

#include "core/gltf_file.h"
#include "core/input_error.h"

namespace {

using ensemble::GltfReadLimits;

/// Small enough that an input which claims much costs little.
GltfReadLimits smallLimits() {
  GltfReadLimits limits;
  limits.max_file_bytes = 1u << 20;
  limits.max_vertices = limits.max_faces = limits.max_keys = 1u << 14;
  limits.max_image_pixels = 1u << 16;
  return limits;
}

/// The same document with chunk lengths that are right: a mutation that made the JSON longer or
/// shorter would otherwise never get past the header.
std::vector<std::byte> withMendedHeader(std::span<const std::byte> bytes) {
  constexpr std::size_t kHeader = 20;  // of the file, and of the JSON chunk
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t marker = text.find(std::string_view("BIN\0", 4), kHeader);
  if (marker == std::string_view::npos || marker < kHeader + 4) return {};
  std::vector<std::byte> json(bytes.begin() + kHeader, bytes.begin() + static_cast<std::ptrdiff_t>(marker) - 4);
  std::vector<std::byte> binary(bytes.begin() + static_cast<std::ptrdiff_t>(marker) + 4, bytes.end());
  json.resize((json.size() + 3) / 4 * 4, std::byte{' '});
  binary.resize((binary.size() + 3) / 4 * 4);

  std::vector<std::byte> mended;
  const auto append = [&mended](const void* data, std::size_t size) {
    const auto* first = static_cast<const std::byte*>(data);
    mended.insert(mended.end(), first, first + size);
  };
  const auto appendNumber = [&append](std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);  // little-endian, as all our machines
    append(&number, sizeof number);
  };
  append("glTF", 4);
  appendNumber(2);
  appendNumber(kHeader + json.size() + 8 + binary.size());
  appendNumber(json.size());
  append("JSON", 4);
  append(json.data(), json.size());
  appendNumber(binary.size());
  append("BIN\0", 4);
  append(binary.data(), binary.size());
  return mended;
}

bool readAndWrite(std::span<const std::byte> bytes) {
  ensemble::RawAsset asset;
  try {
    asset = ensemble::readGlb(bytes, "fuzz.glb", smallLimits());
  } catch (const ensemble::UserError&) {
    return false;
  }
  // From here on nothing may throw: what the reader lets through is sound.
  ensemble::readGlb(ensemble::writeGlb(asset), "again.glb");
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  bool accepted = readAndWrite(bytes);
  if (const std::vector<std::byte> mended = withMendedHeader(bytes); !mended.empty()) {
    accepted = readAndWrite(mended) || accepted;
  }
  return accepted ? 0 : -1;
}
