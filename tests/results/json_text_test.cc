// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/json_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

TEST(JsonText, RoundsToTheUnit) {
  EXPECT_EQ(Rounded(1.23456, 1e-2), 1.23);
  EXPECT_FALSE(std::signbit(Rounded(-1e-5, 1e-2)));
  EXPECT_THROW(Rounded(std::numeric_limits<double>::quiet_NaN(), 1e-2), CheckError);
}

TEST(JsonText, ReplacesBytesThatAreNotUtf8) {
  EXPECT_EQ(DumpLine({{"class", "a\xff\"<b>"}}), "{\"class\":\"a\xEF\xBF\xBD\\\"<b>\"}");
}

TEST(JsonText, HasOneEntryPerLine) {
  EXPECT_EQ(WithEntries({{"version", 1}}, "list", {"1", "2"}),
            "{\"version\":1,\"list\":[\n 1,\n 2\n]}\n");
}

}  // namespace
}  // namespace hullslam
