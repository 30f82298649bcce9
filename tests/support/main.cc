// SPDX-License-Identifier: GPL-3.0-or-later
// The main function of the test programs. CTest runs many tests in one process; so that it shows
// that one of them was skipped, the program then ends with the code that CTest gives in
// HULLSLAM_SKIP_CODE.
#include <gtest/gtest.h>

#include <cstdlib>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const int code = RUN_ALL_TESTS();
  const char* skip_code = std::getenv("HULLSLAM_SKIP_CODE");
  const bool is_skipped = testing::UnitTest::GetInstance()->skipped_test_count() > 0;
  return code == 0 && is_skipped && skip_code != nullptr ? std::atoi(skip_code) : code;
}
