// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/shown_text.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(ShownText, ShortPrintableTextsAreShownAsTheyAre) {
  EXPECT_EQ(ShowText("Camera.fx"), "Camera.fx");
  EXPECT_EQ(ShowText("abcd", 4), "abcd");
}

TEST(ShownText, LongTextsAreCutAndOtherBytesReplaced) {
  EXPECT_EQ(ShowText("abcde", 4), "abcd...");
  EXPECT_EQ(ShowText("a\n\x01\xc3\xa9z"), "a????z");
  EXPECT_EQ(ShowText(std::string(900'000, 'a')).size(), 123U);
}

}  // namespace
}  // namespace hullslam
