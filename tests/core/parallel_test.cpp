#include "core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace ensemble {
namespace {

TEST(ForEachOnThreads, CallsEachJobOnceWhateverTheThreads) {
  for (const unsigned threads : {1u, 2u, 7u, 64u}) {
    for (const std::size_t count : {0u, 1u, 5u, 1000u}) {
      std::vector<std::atomic<int>> calls(count);
      forEachOnThreads(threads, count, [&](std::size_t i, unsigned thread) {
        EXPECT_LT(thread, threads);
        ++calls[i];
      });
      for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(calls[i], 1) << i << " of " << count;
    }
  }
}

TEST(ForEachOnThreads, ThrowsWhatTheFirstFailingJobThrewAndStillTriesAll) {
  for (const unsigned threads : {1u, 2u, 8u}) {
    std::atomic<int> calls{0};
    try {
      forEachOnThreads(threads, 100, [&](std::size_t i, unsigned) {
        ++calls;
        if (i % 10 == 7) throw std::runtime_error(std::to_string(i));
      });
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "7");
    }
    EXPECT_EQ(calls, 100);
  }
}

TEST(ThreadCount, IsOneACoreUnlessAsked) {
  EXPECT_EQ(threadCount(3), 3u);
  EXPECT_GE(threadCount(0), 1u);
}

}  // namespace
}  // namespace ensemble
