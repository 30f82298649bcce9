// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/ascii.h"

#include <gtest/gtest.h>

#include <cctype>

namespace hullslam {
namespace {

// The locale of this test is "C". So the functions of the standard are right for ASCII.
TEST(AsciiTest, EachCharacterIsWhatItIsInTheLocaleC) {
  for (int code = 0; code < 128; ++code) {
    const char c = static_cast<char>(code);
    EXPECT_EQ(IsDigit(c), std::isdigit(code) != 0) << code;
    EXPECT_EQ(IsLetter(c), std::isalpha(code) != 0) << code;
    EXPECT_EQ(IsBlank(c), std::isspace(code) != 0) << code;
    EXPECT_EQ(IsControl(c), std::iscntrl(code) != 0) << code;
  }
}

TEST(AsciiTest, OtherBytesAreNothing) {
  for (int code = 128; code < 256; ++code) {
    const char c = static_cast<char>(code);
    EXPECT_FALSE(IsDigit(c) || IsLetter(c) || IsBlank(c) || IsControl(c)) << code;
  }
}

}  // namespace
}  // namespace hullslam
