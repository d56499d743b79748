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

}  // namespace ensemble
