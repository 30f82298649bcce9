// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/tracking/tracking_options.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace hullslam {
namespace {

TEST(TrackingOptions, AreNamedAfterTheirModuleWithDefaultsInRange) {
  TrackingOptions options;
  OptionTable table;
  options.Bind(table);
  EXPECT_FALSE(table.Entries().empty());
  for (const OptionTable::Entry& entry : table.Entries()) {
    EXPECT_TRUE(entry.key.starts_with("tracking.")) << entry.key;
    EXPECT_NO_THROW(table.Set(entry.key, entry.value, "default")) << entry.key;
    EXPECT_FALSE(entry.help.empty()) << entry.key;
  }
}

TEST(TrackingOptions, AreSetByName) {
  TrackingOptions options;
  OptionTable table;
  options.Bind(table);
  table.Set("tracking.min_inliers", "12", "test");
  EXPECT_EQ(options.min_inliers, 12);
  ExpectInputError([&] { table.Set("tracking.min_inliers", "0", "test"); },
                   {"tracking.min_inliers", "'0'", "expected"});
}

}  // namespace
}  // namespace hullslam
