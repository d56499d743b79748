#include "core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
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

TEST(ForEachInOrder, LeavesInOrderAndKeepsASlotForEachJobUnderWay) {
  for (const unsigned threads : {0u, 1u, 2u, 7u}) {
    for (const std::size_t slots : {1u, 2u, 5u}) {
      for (const std::size_t count : {0u, 1u, 3u, 200u}) {
        const std::thread::id caller = std::this_thread::get_id();
        std::vector<std::size_t> held(slots, 0), left;
        std::vector<std::atomic<bool>> busy(slots);
        const auto make = [&](std::size_t job, std::size_t slot) {
          EXPECT_FALSE(busy[slot].exchange(true)) << "two jobs in a slot";
          held[slot] = job + 1;
          if (job % 3 == 0) std::this_thread::yield();
        };
        const auto leave = [&](std::size_t job, std::size_t slot) {
          EXPECT_EQ(std::this_thread::get_id(), caller);
          EXPECT_EQ(held[slot], job + 1);
          left.push_back(job);
          busy[slot] = false;
        };
        forEachInOrder(threads, {.count = count, .slots = slots, .make = make, .leave = leave});
        ASSERT_EQ(left.size(), count);
        for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(left[i], i);
      }
    }
  }
}

TEST(ForEachInOrder, ThrowsWhatTheFirstFailingJobThrewAfterThoseBeforeItHaveLeft) {
  for (const unsigned threads : {0u, 1u, 4u}) {
    for (const bool fails_in_make : {true, false}) {
      std::size_t left = 0;
      std::atomic<std::size_t> most_begun{0};
      const auto fail = [](std::size_t job) {
        // Of 20 and 21 the later one fails first.
        if (job == 20) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        if (job == 20 || job == 21) throw std::runtime_error(std::to_string(job));
      };
      const auto make = [&](std::size_t job, std::size_t) {
        std::size_t seen = most_begun;
        while (seen < job && !most_begun.compare_exchange_weak(seen, job)) {
        }
        if (fails_in_make) fail(job);
      };
      const auto leave = [&](std::size_t job, std::size_t) {
        EXPECT_EQ(job, left);
        if (!fails_in_make) fail(job);
        ++left;
      };
      try {
        forEachInOrder(threads, {.count = 1000, .slots = 6, .make = make, .leave = leave});
        ADD_FAILURE() << "nothing was thrown";
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "20");
      }
      EXPECT_EQ(left, 20u);
      EXPECT_LE(most_begun, 25u) << "no more than there are slots for";
    }
  }
}

TEST(ThreadCount, IsOneACoreUnlessAsked) {
  EXPECT_EQ(threadCount(3), 3u);
  EXPECT_GE(threadCount(0), 1u);
}

}  // namespace
}  // namespace ensemble
