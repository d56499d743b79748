#include "core/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace ensemble {
namespace {
bool g_progress_enabled = true;
constexpr int kBarWidth = 30;
}  // namespace

void Progress::setEnabled(bool enabled) { g_progress_enabled = enabled; }

Progress::Progress(std::string label, std::uint64_t total)
    : label_(std::move(label)), total_(total), shown_(g_progress_enabled && isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (shown_ && done_ > 0) std::fputc('\n', stderr);
}

void Progress::advance(std::uint64_t steps) {
  done_ += steps;
  if (!shown_) return;
  const auto now = std::chrono::steady_clock::now();
  if (done_ < total_ && now - last_drawn_ < std::chrono::milliseconds(100)) return;
  last_drawn_ = now;
  draw();
}

void Progress::draw() {
  const std::uint64_t total = std::max<std::uint64_t>(total_, 1);
  const int filled = static_cast<int>(std::min(done_, total) * kBarWidth / total);
  std::fprintf(stderr, "\r%s [%.*s%*s] %llu/%llu", label_.c_str(), filled, "##############################",
               kBarWidth - filled, "", static_cast<unsigned long long>(done_),
               static_cast<unsigned long long>(total_));
  std::fflush(stderr);
}

}  // namespace ensemble
