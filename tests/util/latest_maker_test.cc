// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/latest_maker.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace hullslam {
namespace {

TEST(LatestMaker, KeepsAllResultsUntilTheyAreTaken) {
  LatestMaker<int, int> maker([](int task) { return 10 * task; });
  EXPECT_TRUE(maker.TakeResults().empty());
  for (const int task : {1, 2, 3}) {
    maker.Post(task);
    maker.WaitUntilIdle();
    EXPECT_FALSE(maker.IsBusy());
  }
  EXPECT_EQ(maker.TakeResults(), (std::vector<int>{10, 20, 30}));
  EXPECT_TRUE(maker.TakeResults().empty());
}

TEST(LatestMaker, ThrowsWhatMakingThrows) {
  LatestMaker<int, int> maker([](int task) -> int {
    if (task == 2) {
      throw std::runtime_error("two");
    }
    return task;
  });
  maker.Post(1);
  maker.WaitUntilIdle();
  maker.Post(2);
  maker.WaitUntilIdle();
  EXPECT_THROW(maker.TakeResults(), std::runtime_error);
}

}  // namespace
}  // namespace hullslam
