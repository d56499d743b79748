// What `ensemble --version` prints.
#pragma once

#include <string>

namespace ensemble::cli {

/// Version, build type, Vulkan device ("none" where there is none).
std::string versionText();

}  // namespace ensemble::cli
