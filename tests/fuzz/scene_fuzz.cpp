// Fuzzes parseScene: hostile text is refused with a UserError or read, never more.
#include <cstdint>
#include <string>

#include "core/input_error.h"
#include "core/scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    ensemble::parseScene(std::string(reinterpret_cast<const char*>(data), size), "fuzz.yaml");
  } catch (const ensemble::UserError&) {
    return -1;
  }
  return 0;
}
