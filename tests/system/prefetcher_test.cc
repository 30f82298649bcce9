// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/prefetcher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

namespace hullslam {
namespace {

// Counts 0, 1, 2 ... below `end`.
std::function<std::optional<int>()> CountTo(int end) {
  return [next = 0, end]() mutable { return next < end ? std::optional(next++) : std::nullopt; };
}

TEST(Prefetcher, DeliversInOrderAndStaysAtTheEnd) {
  Prefetcher<int> prefetcher(CountTo(1000), 3);
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(prefetcher.Next(), i);
  }
  EXPECT_EQ(prefetcher.Next(), std::nullopt);
  EXPECT_EQ(prefetcher.Next(), std::nullopt);
}

TEST(Prefetcher, WorksForItemsThatCannotBeCopied) {
  int next = 0;
  Prefetcher<std::unique_ptr<int>> prefetcher(
      [&next]() -> std::optional<std::unique_ptr<int>> {
        return next < 2 ? std::optional(std::make_unique<int>(next++)) : std::nullopt;
      },
      1);
  EXPECT_EQ(**prefetcher.Next(), 0);
  EXPECT_EQ(**prefetcher.Next(), 1);
  EXPECT_FALSE(prefetcher.Next());
}

TEST(Prefetcher, RunsAheadInAnotherThreadByAtMostItsCapacity) {
  constexpr int kCapacity = 2;
  std::atomic<int> taken{0};
  std::atomic<int> farthest{0};
  std::atomic<bool> other_thread{false};
  const std::thread::id consumer = std::this_thread::get_id();
  int next = 0;
  Prefetcher<int> prefetcher(
      [&]() -> std::optional<int> {
        other_thread = std::this_thread::get_id() != consumer;
        // Of the items made before this one, `taken` were taken and at most kCapacity wait.
        farthest = std::max(farthest.load(), next - taken.load());
        return next < 500 ? std::optional(next++) : std::nullopt;
      },
      kCapacity);
  // Counted before the call, because the producer may look while an item is being taken.
  for (taken = 1; prefetcher.Next(); ++taken) {
  }
  EXPECT_TRUE(other_thread);
  EXPECT_EQ(taken, 501);
  EXPECT_LE(farthest, kCapacity);
}

TEST(Prefetcher, RethrowsAfterTheItemsThatCameBefore) {
  int next = 0;
  Prefetcher<int> prefetcher(
      [&next]() -> std::optional<int> {
        if (next == 3) {
          throw std::runtime_error("broken image");
        }
        return next++;
      },
      8);
  EXPECT_EQ(prefetcher.Next(), 0);
  EXPECT_EQ(prefetcher.Next(), 1);
  EXPECT_EQ(prefetcher.Next(), 2);
  try {
    prefetcher.Next();
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()), "broken image");
  }
  EXPECT_EQ(prefetcher.Next(), std::nullopt) << "after the exception comes the end";
}

TEST(Prefetcher, MayBeDestroyedWhileTheProducerWaits) {
  std::atomic<int> produced{0};
  {
    Prefetcher<int> prefetcher([&]() -> std::optional<int> { return produced++; }, 2);
    EXPECT_EQ(prefetcher.Next(), 0);
  }
  EXPECT_LE(produced, 4) << "one item was taken, two wait, and one is being made";
}

TEST(Prefetcher, MayBeDestroyedWithAFailureThatWasNotRethrown) {
  const auto fail = []() -> std::optional<int> { throw std::runtime_error("unseen"); };
  EXPECT_NO_THROW(Prefetcher<int>(fail, 1));
}

}  // namespace
}  // namespace hullslam
