#include "cli/version.h"

#include <fmt/format.h>

#include "renderer/renderer.h"

namespace ensemble::cli {

std::string versionText() {
  return fmt::format("ensemble {} ({}), Vulkan device: {}", ENSEMBLE_VERSION, ENSEMBLE_BUILD_TYPE,
                     deviceName());
}

}  // namespace ensemble::cli
