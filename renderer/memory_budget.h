// Bytes in use on a device, counted for all who share it.
#pragma once

#include <atomic>
#include <cstdint>

namespace ensemble {

/// May be used from several threads.
class MemoryBudget {
 public:
  /// Takes bytes unless more than `most` would be in use then; says whether it did.
  bool take(std::uint64_t bytes, std::uint64_t most) {
    std::uint64_t used = used_;
    do {
      if (used > most || bytes > most - used) return false;
    } while (!used_.compare_exchange_weak(used, used + bytes));
    return true;
  }
  void giveBack(std::uint64_t bytes) { used_ -= bytes; }
  std::uint64_t used() const { return used_; }

 private:
  std::atomic<std::uint64_t> used_{0};
};

}  // namespace ensemble
