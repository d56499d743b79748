#include "core/parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "core/check.h"

namespace ensemble {
namespace {

/// What the threads of forEachInOrder share.
class OrderedRun {
 public:
  explicit OrderedRun(const OrderedJobs& jobs) : jobs_(jobs), slots_(jobs.slots) {}

  /// Makes jobs until there are no more, or one has failed.
  void makeJobs() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [&] { return isOver() || begun_ < left_ + slots_.size(); });
      if (isOver()) return;
      const std::size_t job = begun_++;
      lock.unlock();
      std::exception_ptr error;
      try {
        jobs_.make(job, job % slots_.size());
      } catch (...) {
        error = std::current_exception();
      }
      lock.lock();
      slots_[job % slots_.size()] = {.is_made = true, .error = error};
      if (error) is_stopped_ = true;  // those before it are begun, those after it are not wanted
      changed_.notify_all();
    }
  }

  /// Lets jobs leave as they are made. @throws as forEachInOrder
  void leaveJobs() {
    for (std::size_t job = 0; job < jobs_.count; ++job) {
      const std::size_t slot = job % slots_.size();
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return slots_[slot].is_made; });
        if (slots_[slot].error) std::rethrow_exception(slots_[slot].error);
      }
      jobs_.leave(job, slot);
      const std::lock_guard lock(mutex_);
      slots_[slot].is_made = false;
      ++left_;
      changed_.notify_all();
    }
  }

  void stop() {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
    changed_.notify_all();
  }

 private:
  struct Slot {
    bool is_made = false;
    std::exception_ptr error;
  };
  bool isOver() const { return is_stopped_ || begun_ == jobs_.count; }

  const OrderedJobs& jobs_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Slot> slots_;
  std::size_t begun_ = 0, left_ = 0;  // jobs
  bool is_stopped_ = false;
};

}  // namespace

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

void forEachInOrder(unsigned threads, const OrderedJobs& jobs) {
  ENSEMBLE_CHECK(jobs.slots > 0);
  OrderedRun run(jobs);
  std::vector<std::jthread> makers;
  makers.reserve(threads);
  try {
    while (makers.size() < std::min<std::size_t>(threads, jobs.count))
      makers.emplace_back([&] { run.makeJobs(); });
  } catch (const std::system_error&) {  // no more threads: those that there are do it
  }
  if (makers.empty()) {
    for (std::size_t job = 0; job < jobs.count; ++job) {
      jobs.make(job, 0);
      jobs.leave(job, 0);
    }
    return;
  }
  try {
    run.leaveJobs();
  } catch (...) {
    run.stop();  // the makers end, and are waited for
    throw;
  }
}

}  // namespace ensemble
