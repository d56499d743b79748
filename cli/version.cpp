#include "cli/version.h"

#include <fmt/format.h>

namespace ensemble::cli {

std::string versionText() { return fmt::format("ensemble {} ({})", ENSEMBLE_VERSION, ENSEMBLE_BUILD_TYPE); }

}  // namespace ensemble::cli
