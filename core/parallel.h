// Independent jobs on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace ensemble {

/// @param wished 0: one for each core. Never 0.
unsigned threadCount(unsigned wished);

/// Calls work(0, thread) to work(count - 1, thread), each once, in any order, from up to `threads` threads,
/// this one among them; with one thread in their order. `thread` counts from 0: what can't be shared is held
/// per thread. Fewer threads do it if the system gives no more.
/// @param threads at least 1
/// @throws what work threw: of several, that of the least number, as if they had run in order. All jobs have
///         been tried then.
void forEachOnThreads(unsigned threads, std::size_t count,
                      const std::function<void(std::size_t, unsigned)>& work);

/// Jobs whose results leave one after the other. A *slot* is a job's own from the begin of its `make` to the
/// end of its `leave`: what it needs and gives is held per slot.
struct OrderedJobs {
  using Step = std::function<void(std::size_t job, std::size_t slot)>;
  std::size_t count = 0;
  std::size_t slots = 1;  ///< as many jobs are under way at most; at least 1
  Step make;              ///< on any thread; begun in the order of jobs
  Step leave;             ///< on the caller's thread, in the order of jobs
};

/// Makes and leaves jobs 0 .. count - 1. Fewer threads do it if the system gives no more.
/// @param threads that make; the caller's leaves meanwhile. 0: the caller's does both, job by job
/// @throws what the first failing job threw, by number; all before it have left, none after it leaves.
void forEachInOrder(unsigned threads, const OrderedJobs& jobs);

}  // namespace ensemble
