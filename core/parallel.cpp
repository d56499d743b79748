#include "core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "core/check.h"

namespace ensemble {

unsigned threadCount(unsigned wished) {
  return wished > 0 ? wished : std::max(1u, std::thread::hardware_concurrency());
}

void forEachOnThreads(unsigned threads, std::size_t count,
                      const std::function<void(std::size_t, unsigned)>& work) {
  ENSEMBLE_CHECK(threads > 0);
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr error;  // of job `failed`
  std::size_t failed = count;
  const auto run = [&](unsigned thread) {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i, thread);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (i > failed) continue;
        failed = i;
        error = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> others;
    others.reserve(std::min<std::size_t>(threads, count));
    try {
      for (unsigned t = 1; t < std::min<std::size_t>(threads, count); ++t) others.emplace_back(run, t);
    } catch (const std::system_error&) {  // no more threads: those that there are do it
    }
    run(0);
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace ensemble
