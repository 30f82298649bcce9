// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/latest_worker.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

namespace hullslam {
namespace {

// A worker that records its tasks and stays in the first one until the test releases it.
class LatestWorkerTest : public testing::Test {
 protected:
  ~LatestWorkerTest() override { LetGo(); }

  void Work(int task) {
    done_.push_back(task);
    if (done_.size() == 1) {
      has_begun_.set_value();
      go_.get_future().wait();
    }
  }
  // Posts a task and waits until it is worked on.
  void Occupy(int task) {
    worker_.Post(task);
    has_begun_.get_future().wait();
  }
  void LetGo() {
    if (!is_free_) {
      is_free_ = true;
      go_.set_value();
    }
  }

  std::vector<int> done_;  // written by the worker's thread
  std::promise<void> has_begun_;
  std::promise<void> go_;
  bool is_free_ = false;
  LatestWorker<int> worker_{[this](int task) { Work(task); }};
};

TEST_F(LatestWorkerTest, AnIdleWorkerTakesEveryTask) {
  LetGo();
  for (int i = 0; i < 100; ++i) {
    worker_.Post(i);
    worker_.WaitUntilIdle();
    EXPECT_EQ(done_.size(), static_cast<size_t>(i + 1));
    EXPECT_EQ(done_.back(), i);
  }
}

TEST_F(LatestWorkerTest, OnlyTheNewestOfSeveralWaitingTasksIsDone) {
  Occupy(1);
  for (const int task : {2, 3, 4}) {
    worker_.Post(task);
  }
  LetGo();
  worker_.WaitUntilIdle();
  EXPECT_EQ(done_, (std::vector<int>{1, 4}));
}

TEST_F(LatestWorkerTest, IsBusyWhileATaskWaitsOrIsWorkedOn) {
  EXPECT_FALSE(worker_.IsBusy());
  Occupy(1);
  EXPECT_TRUE(worker_.IsBusy());
  worker_.Post(2);
  EXPECT_TRUE(worker_.IsBusy());
  LetGo();
  worker_.WaitUntilIdle();
  EXPECT_FALSE(worker_.IsBusy());
  EXPECT_EQ(done_, (std::vector<int>{1, 2})) << "idle means that nothing waits either";
}

TEST_F(LatestWorkerTest, WaitingForAWorkerWithoutTasksReturnsImmediately) {
  worker_.WaitUntilIdle();
  EXPECT_TRUE(done_.empty());
}

TEST(LatestWorker, ItsDestructorDropsWaitingTasks) {
  std::vector<int> done;
  std::promise<void> has_begun;
  std::promise<void> go;
  std::thread helper;
  {
    LatestWorker<int> worker([&](int task) {
      done.push_back(task);
      has_begun.set_value();
      go.get_future().wait();
    });
    worker.Post(1);
    has_begun.get_future().wait();
    worker.Post(2);
    helper = std::thread([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));  // the destructor has begun
      go.set_value();
    });
  }
  helper.join();
  EXPECT_EQ(done, std::vector<int>{1});
}

TEST(LatestWorker, CarriesTasksThatCannotBeCopied) {
  int sum = 0;
  LatestWorker<std::unique_ptr<int>> worker([&](std::unique_ptr<int> task) { sum += *task; });
  worker.Post(std::make_unique<int>(5));
  worker.WaitUntilIdle();
  EXPECT_EQ(sum, 5);
}

TEST(LatestWorker, AnExceptionEndsTheWorkAndReachesTheCallerEveryTime) {
  std::vector<int> done;
  LatestWorker<int> worker([&](int task) {
    done.push_back(task);
    throw std::runtime_error("broken");
  });
  EXPECT_NO_THROW(worker.RethrowFailure());
  worker.Post(1);
  worker.WaitUntilIdle();
  EXPECT_THROW(worker.RethrowFailure(), std::runtime_error);
  EXPECT_THROW(worker.RethrowFailure(), std::runtime_error);
  worker.Post(2);
  EXPECT_FALSE(worker.IsBusy()) << "a task that was posted after the exception is never begun";
  worker.WaitUntilIdle();
  EXPECT_EQ(done, std::vector<int>{1});
}

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
