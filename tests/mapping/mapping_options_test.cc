// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/mapping/mapping_options.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace hullslam {
namespace {

TEST(MappingOptions, AreNamedAfterTheirModuleWithDefaultsInRange) {
  MappingOptions options;
  OptionTable table;
  options.Bind(table);
  EXPECT_FALSE(table.Entries().empty());
  for (const OptionTable::Entry& entry : table.Entries()) {
    EXPECT_TRUE(entry.key.starts_with("mapping.")) << entry.key;
    EXPECT_NO_THROW(table.Set(entry.key, entry.value, "default")) << entry.key;
    EXPECT_FALSE(entry.help.empty()) << entry.key;
  }
}

TEST(MappingOptions, AreSetByName) {
  MappingOptions options;
  OptionTable table;
  options.Bind(table);
  table.Set("mapping.cull_keyframes", "false", "test");
  EXPECT_EQ(options.cull_keyframes, false);
  table.Set("mapping.compact_keyframes", "0", "test");
  EXPECT_EQ(options.compact_keyframes, false);
  ExpectInputError([&] { table.Set("mapping.cull_keyframes", "maybe", "test"); },
                   {"mapping.cull_keyframes", "'maybe'", "expected"});
}

}  // namespace
}  // namespace hullslam
