// A progress bar on standard error, only where that is a terminal and --quiet is not given.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace ensemble {

class Progress {
 public:
  /// Shows nothing until `advance`; `total` steps of `label`.
  Progress(std::string label, std::uint64_t total);
  ~Progress();  ///< ends the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void advance(std::uint64_t steps = 1);

  static void setEnabled(bool enabled);  ///< off with --quiet

 private:
  void draw();
  std::string label_;
  std::uint64_t total_ = 0, done_ = 0;
  bool shown_ = false;
  std::chrono::steady_clock::time_point last_drawn_{};
};

}  // namespace ensemble
