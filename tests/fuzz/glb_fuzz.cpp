// Fuzzes readGlb: hostile bytes are refused with a UserError or read, never more; what was read can
// be written, and read again.
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/gltf_file.h"
#include "core/input_error.h"

namespace {

using ensemble::GltfReadOptions;

/// Small enough that an input which claims much costs little.
GltfReadOptions smallLimits() {
  GltfReadOptions limits;
  limits.max_file_bytes = 1u << 20;
  limits.max_vertices = limits.max_faces = limits.max_keys = 1u << 14;
  limits.max_image_pixels = 1u << 16;
  return limits;
}

/// The same document with chunk lengths that are right: a mutation that made the JSON longer or
/// shorter would otherwise never get past the header.
std::string withMendedHeader(std::string_view bytes) {
  constexpr std::size_t kHeader = 20;  // of the file, and of the JSON chunk
  const std::size_t marker = bytes.find(std::string_view("BIN\0", 4), kHeader);
  if (marker == std::string_view::npos || marker < kHeader + 4) return {};
  std::string json(bytes.substr(kHeader, marker - 4 - kHeader)), binary(bytes.substr(marker + 4));
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4);

  const auto number = [](std::size_t value) {  // little-endian, as all our machines
    const auto bits = static_cast<std::uint32_t>(value);
    return std::string(reinterpret_cast<const char*>(&bits), sizeof bits);
  };
  return "glTF" + number(2) + number(kHeader + json.size() + 8 + binary.size()) + number(json.size()) +
         "JSON" + json + number(binary.size()) + std::string("BIN\0", 4) + binary;
}

bool readAndWrite(std::string_view bytes) {
  ensemble::RawAsset asset;
  try {
    asset = ensemble::readGlb(std::as_bytes(std::span(bytes)), "fuzz.glb", smallLimits());
  } catch (const ensemble::UserError&) {
    return false;
  }
  // From here on nothing may throw: what the reader lets through is sound.
  ensemble::readGlb(ensemble::writeGlb(asset), "again.glb");
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  bool accepted = readAndWrite(bytes);
  if (const std::string mended = withMendedHeader(bytes); !mended.empty()) {
    accepted = readAndWrite(mended) || accepted;
  }
  return accepted ? 0 : -1;
}
