// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/loop/loop_options.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace hullslam {
namespace {

TEST(LoopOptions, AreNamedAfterTheirModuleWithDefaultsInRange) {
  LoopOptions options;
  OptionTable table;
  options.Bind(table);
  EXPECT_FALSE(table.Entries().empty());
  for (const OptionTable::Entry& entry : table.Entries()) {
    EXPECT_TRUE(entry.key.starts_with("loop.")) << entry.key;
    EXPECT_NO_THROW(table.Set(entry.key, entry.value, "default")) << entry.key;
    EXPECT_FALSE(entry.help.empty()) << entry.key;
  }
}

TEST(LoopOptions, AreSetByName) {
  LoopOptions options;
  OptionTable table;
  options.Bind(table);
  table.Set("loop.closing", "false", "test");
  EXPECT_FALSE(options.enabled);
  table.Set("loop.min_supporters", "0", "test");
  EXPECT_EQ(options.min_supporters, 0);
  ExpectInputError([&] { table.Set("loop.min_matches", "3", "test"); },
                   {"loop.min_matches", "'3'", "expected"});
  ExpectInputError([&] { table.Set("loop.turn_base", "-0.1", "test"); },
                   {"loop.turn_base", "'-0.1'", "expected"});
}

// Each key has a field of its own.
TEST(LoopOptions, NoTwoKeysSetTheSame) {
  LoopOptions options;
  OptionTable table;
  options.Bind(table);
  const std::vector<OptionTable::Entry> before = table.Entries();
  for (const OptionTable::Entry& entry : before) {
    const bool is_switch = entry.value == "true" || entry.value == "false";
    const std::string other = is_switch ? (entry.value == "true" ? "false" : "true") : "77";
    table.Set(entry.key, other, "test");
    int changed = 0;
    for (const OptionTable::Entry& now : table.Entries()) {
      for (const OptionTable::Entry& then : before) {
        changed += now.key == then.key && now.value != then.value ? 1 : 0;
      }
    }
    EXPECT_EQ(changed, 1) << entry.key;
    table.Set(entry.key, entry.value, "test");
  }
}

}  // namespace
}  // namespace hullslam
