// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/program.h"

#include <ceres/ceres.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <future>
#include <limits>
#include <new>

namespace hullslam {
namespace {

// What Ceres reports of a cost that is no number, on several lines that name its source files.
struct NoNumber {
  template <typename Scalar>
  bool operator()(const Scalar* x, Scalar* residual) const {
    residual[0] = x[0] * std::numeric_limits<double>::quiet_NaN();
    return true;
  }
};

TEST(PrepareStreams, KeepsTheLogOfCeresOffStderr) {
  PrepareStreams();
  double x = 1.0;
  ceres::Problem problem;
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<NoNumber, 1, 1>(new NoNumber()), nullptr,
                           &x);
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ::testing::internal::CaptureStderr();
  ceres::Solve(options, &problem, &summary);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(summary.termination_type, ceres::FAILURE);
}

TEST(PrintFailure, IsOneLineOfPrintableCharacters) {
  ::testing::internal::CaptureStderr();
  PrintFailure("no\x1b[2J\nforged: a line");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "error: no?[2J?forged: a line\n");
}

TEST(RunMain, SaysThatMemoryIsShort) {
  ::testing::internal::CaptureStderr();
  const auto run = [](int, char**) -> int { throw std::bad_alloc(); };
  EXPECT_EQ(RunMain(run, 0, nullptr), kFailed);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "error: there is not enough memory\n");
}

// Needs more than the limit of the stack; the result is of the first bytes.
int UseStack(size_t bytes) {
  volatile auto* const room = static_cast<volatile char*>(__builtin_alloca(bytes));
  for (size_t i = 0; i < bytes; i += 1024) {
    room[i] = 1;
  }
  return room[0];
}

TEST(CallWithStack, ASmallLimitOfTheStackDoesNotMatter) {
  constexpr size_t kNeeded = 4 << 20;
  pthread_attr_t small;
  pthread_attr_init(&small);
  pthread_attr_setstacksize(&small, 128 << 10);
  pthread_setattr_default_np(&small);  // as after ulimit -s 128
  EXPECT_EQ(CallWithStack([] { return UseStack(kNeeded); }), 1);
  EXPECT_EQ(std::async(std::launch::async, [] { return UseStack(kNeeded); }).get(), 1);
  EXPECT_EQ(CallWithStack([] { return 7; }), 7);
  EXPECT_THROW(CallWithStack([]() -> int { throw InputError("a"); }), InputError);
}

}  // namespace
}  // namespace hullslam
