#include "core/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace ensemble {
namespace {

spdlog::logger& logger() {
  static const std::shared_ptr<spdlog::logger> instance = [] {
    auto made = spdlog::stderr_logger_mt("ensemble");
    made->set_pattern("ensemble: %v");
    return made;
  }();
  return *instance;
}

}  // namespace

void setLogLevel(LogLevel level) {
  logger().set_level(level == LogLevel::kQuiet    ? spdlog::level::err
                     : level == LogLevel::kNormal ? spdlog::level::info
                                                  : spdlog::level::debug);
}

void logWarning(const std::string& message) { logger().warn("warning: {}", message); }
void logNote(const std::string& message) { logger().info("{}", message); }
void logDetail(const std::string& message) { logger().debug("{}", message); }

}  // namespace ensemble
