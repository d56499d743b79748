// Log lines to standard error, through spdlog; -q and -v set the level.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace ensemble {

enum class LogLevel { kQuiet, kNormal, kVerbose };  ///< errors only, warnings and notes too, details too
void setLogLevel(LogLevel level);

void logWarning(const std::string& message);  ///< "ensemble: warning: MESSAGE"; shown unless quiet
void logNote(const std::string& message);     ///< shown unless quiet
void logDetail(const std::string& message);   ///< shown with --verbose

}  // namespace ensemble
