// Fuzzes parseManifest: hostile text is refused with a UserError or read; what was read is written
// so that it can be read again, and the second writing equals the first.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/input_error.h"
#include "core/wardrobe_files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ensemble::Manifest manifest;
  try {
    manifest = ensemble::parseManifest(std::string(reinterpret_cast<const char*>(data), size), "fuzz.json");
  } catch (const ensemble::UserError&) {
    return -1;
  }
  const std::string text = ensemble::writeManifest(manifest);
  if (ensemble::writeManifest(ensemble::parseManifest(text, "again.json")) != text) std::abort();
  return 0;
}
