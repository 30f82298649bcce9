// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstdio>
#include <sstream>
#include <string>

#include "support/run_program.h"

namespace hullslam {
namespace {

// The camera of the example moves to the right by 1 cm per frame, at 30 frames per second.
TEST(Minimal, PrintsOnePosePerFrame) {
  const ProgramResult result = RunProgram("minimal", {});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  std::istringstream lines(result.output);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    double stamp = 0.0;
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf s: %lf %lf %lf m", &stamp, &x, &y, &z), 4) << line;
    EXPECT_NEAR(stamp, count / 30.0, 1e-3);
    EXPECT_NEAR(x, 0.01 * count, 0.003) << line;
    EXPECT_NEAR(y, 0.0, 0.003) << line;
    EXPECT_NEAR(z, 0.0, 0.003) << line;
  }
  EXPECT_EQ(count, 20);
}

}  // namespace
}  // namespace hullslam
