// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/check.h"

#include <gtest/gtest.h>

#include <string>

namespace hullslam {
namespace {

TEST(Check, PassesIfTheConditionHolds) { EXPECT_NO_THROW(Check(true, "never said")); }

TEST(Check, NamesReasonFileAndLine) {
  const int line = __LINE__ + 2;
  try {
    Check(false, "the sky is not blue");
    FAIL() << "nothing thrown";
  } catch (const CheckError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("the sky is not blue"), std::string::npos) << message;
    EXPECT_TRUE(message.starts_with("tests/util/check_test.cc:")) << message;
    EXPECT_NE(message.find(std::to_string(line)), std::string::npos) << message;
  }
}

TEST(Check, ThrowsALogicError) { EXPECT_THROW(Check(false, ""), std::logic_error); }

}  // namespace
}  // namespace hullslam
