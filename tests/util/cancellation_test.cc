// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/cancellation.h"

#include <gtest/gtest.h>

#include <thread>

namespace hullslam {
namespace {

TEST(Cancellation, StaysRequestedUntilReset) {
  Cancellation cancellation;
  EXPECT_FALSE(cancellation.IsRequested());
  cancellation.Request();
  cancellation.Request();
  EXPECT_TRUE(cancellation.IsRequested());
  EXPECT_TRUE(cancellation.IsRequested());
  cancellation.Reset();
  EXPECT_FALSE(cancellation.IsRequested());
}

TEST(Cancellation, ANullPointerIsNeverRequested) {
  Cancellation cancellation;
  EXPECT_FALSE(IsRequested(nullptr));
  EXPECT_FALSE(IsRequested(&cancellation));
  cancellation.Request();
  EXPECT_TRUE(IsRequested(&cancellation));
}

// Writes made before the request are visible after it; ThreadSanitizer checks this.
TEST(Cancellation, EndsALoopOnAnotherThread) {
  Cancellation cancellation;
  int reason = 0;
  std::thread worker([&] {
    while (!cancellation.IsRequested()) {
      std::this_thread::yield();
    }
    EXPECT_EQ(reason, 42);
  });
  reason = 42;
  cancellation.Request();
  worker.join();
}

}  // namespace
}  // namespace hullslam
