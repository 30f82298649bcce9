// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/option_table.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "support/expect_error.h"

namespace hullslam {
namespace {

struct Fields {
  double length = 1.5;
  int count = 3;
  uint64_t seed = 7;
  bool flag = false;
  std::string mode = "fast";

  OptionTable Bind() {
    OptionTable table;
    table.Add("b.length", &length, Range::Positive(), "length, m");
    table.Add("b.count", &count, Range::Between(1, 10), "how many");
    table.Add("a.seed", &seed, Range::AtLeast(0), "seed");
    table.Add("flag", &flag, "whether");
    table.Add("mode", &mode, {"fast", "exact"}, "how");
    table.AddIgnored("Viewer.Size");
    return table;
  }
};

TEST(Range, ContainsItsClosedEndsAndNoInfiniteNumber) {
  EXPECT_TRUE(Range::Between(1.0, 2.0).Contains(1.0));
  EXPECT_TRUE(Range::Between(1.0, 2.0).Contains(2.0));
  EXPECT_FALSE(Range::Between(1.0, 2.0).Contains(2.1));
  EXPECT_FALSE(Range::Positive().Contains(0.0));
  EXPECT_TRUE(Range::AtLeast(0.0).Contains(0.0));
  EXPECT_FALSE(Range::Any().Contains(std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(Range::Any().Contains(std::numeric_limits<double>::quiet_NaN()));
}

TEST(Range, IsDescribedInWords) {
  EXPECT_EQ(Range::Positive().ToString(), "> 0");
  EXPECT_EQ(Range::AtLeast(1).ToString(), ">= 1");
  EXPECT_EQ(Range::Between(0, 1).ToString(), "from 0 to 1");
  EXPECT_EQ(Range::Any().ToString(), "of any size");
}

class MapOption : public ::testing::Test {
 protected:
  MapOption() {
    table_.Add("sizes", &sizes_, Range::Between(0.001, 1000.0), "sizes, m");
    table_.Add("length", &length_, Range::Positive(), "length, m");
  }
  std::map<std::string, double> sizes_;
  double length_ = 1.0;
  OptionTable table_;
};

TEST_F(MapOption, IsSetFromPairs) {
  table_.Set("sizes", "cup:0.1, potted plant : 0.5,a b: 2", "--set");
  EXPECT_EQ(sizes_,
            (std::map<std::string, double>{{"a b", 2.0}, {"cup", 0.1}, {"potted plant", 0.5}}));
  EXPECT_EQ(table_.Entries()[1].value, "a b:2,cup:0.1,potted plant:0.5");
  table_.Set("sizes", "", "--set");
  EXPECT_TRUE(sizes_.empty());
  EXPECT_TRUE(table_.IsMap("sizes"));
  EXPECT_FALSE(table_.IsMap("length"));
  EXPECT_FALSE(table_.IsMap("width"));
}

TEST_F(MapOption, BrokenPairsAreRefusedAndChangeNothing) {
  table_.Set("sizes", "cup:0.1", "--set");
  for (const char* const text :
       {"cup", "cup:", ":1", "cup:x", "cup:0", "cup:-1", "cup:nan", "cup:1e9", "cup:1,cup:2",
        "a:b:2", "cup:1,,mug:2", "cup:1 mug:2"}) {
    ExpectInputError(
        [&] { table_.Set("sizes", text, "--set"); },
        {"--set: sizes is '" + std::string(text) + "'", "name:number pairs", "from 0.001 to 1000"});
  }
  EXPECT_EQ(sizes_, (std::map<std::string, double>{{"cup", 0.1}}));
}

// If a shared key and one of its members are both set, the later one wins.
TEST(OptionTable, ASharedKeySetsItsMembers) {
  double first = 1.0;
  double second = 1.0;
  OptionTable table;
  table.Add("first", &first, Range::Between(0.0, 9.0), "one");
  table.Add("second", &second, Range::Between(0.0, 9.0), "another");
  table.AddShared("both", {"first", "second"}, "both of them");
  table.Set("both", "3", "test");
  table.Set("second", "4", "test");
  EXPECT_EQ(first, 3.0);
  EXPECT_EQ(second, 4.0);
  table.Set("both", "5", "test");
  EXPECT_EQ(second, 5.0);
  EXPECT_THROW(table.Set("both", "10", "test"), InputError);
  const std::vector<OptionTable::Entry> entries = table.Entries();
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_EQ(entries[0].key, "both");
  EXPECT_TRUE(entries[0].is_shared);
  EXPECT_EQ(entries[0].expected, entries[1].expected);
  EXPECT_FALSE(entries[1].is_shared);
  EXPECT_THROW(table.AddShared("none", {"third"}, "not bound"), CheckError);
}

TEST(OptionTable, SetsAnEnumByName) {
  enum class Colour { kRed, kGreen, kBlue };
  Colour colour = Colour::kGreen;
  OptionTable table;
  table.AddEnum("colour", &colour, {"red", "green", "blue"}, "of the wall");
  EXPECT_EQ(table.Entries()[0].value, "green");
  EXPECT_EQ(table.Entries()[0].expected, "one of: red, green, blue");
  table.Set("colour", "blue", "test");
  EXPECT_EQ(colour, Colour::kBlue);
  EXPECT_EQ(table.Entries()[0].value, "blue");
  ExpectInputError([&] { table.Set("colour", "Red", "x.yaml"); },
                   {"x.yaml", "colour", "'Red'", "one of: red, green, blue"});
  EXPECT_EQ(colour, Colour::kBlue);
}

TEST(OptionTable, SetsTheBoundFields) {
  Fields fields;
  OptionTable table = fields.Bind();
  table.Set("b.length", "+2.25", "test");
  table.Set("b.count", "10", "test");
  table.Set("a.seed", "18446744073709551615", "test");
  table.Set("flag", "1", "test");
  table.Set("mode", "exact", "test");
  table.Set("Viewer.Size", "anything", "test");
  EXPECT_EQ(fields.length, 2.25);
  EXPECT_EQ(fields.count, 10);
  EXPECT_EQ(fields.seed, std::numeric_limits<uint64_t>::max());
  EXPECT_TRUE(fields.flag);
  EXPECT_EQ(fields.mode, "exact");
}

TEST(OptionTable, RefusedValuesChangeNothing) {
  Fields fields;
  OptionTable table = fields.Bind();
  const auto expect = [&](const char* key, const char* value, const char* expected) {
    ExpectInputError([&] { table.Set(key, value, "file.yaml:3"); },
                     {"file.yaml:3: ", key, std::string("'") + value + "'", expected});
  };
  expect("b.length", "0", "a number > 0");
  expect("b.length", "nan", "a number > 0");
  expect("b.length", "1.5m", "a number > 0");
  expect("b.length", "", "a number > 0");
  expect("b.count", "0", "an integer from 1 to 10");
  expect("b.count", "2.5", "an integer from 1 to 10");
  expect("b.count", "99999999999", "an integer from 1 to 10");
  expect("a.seed", "-1", "an integer >= 0");
  expect("flag", "yes", "true or false");
  expect("mode", "slow", "one of: fast, exact");
  EXPECT_EQ(fields.length, 1.5);
  EXPECT_EQ(fields.count, 3);
  EXPECT_EQ(fields.seed, 7U);
  EXPECT_EQ(fields.mode, "fast");
}

TEST(OptionTable, AnUnknownKeyGetsASuggestion) {
  Fields fields;
  OptionTable table = fields.Bind();
  ExpectInputError([&] { table.Set("b.lenght", "1", "--set"); },
                   {"--set: ", "unknown key 'b.lenght'", "did you mean 'b.length'"});
  try {
    table.Set("PointCloud.Resolution", "1", "--set");
    ADD_FAILURE() << "an unknown key was accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), "--set: unknown key 'PointCloud.Resolution'");
  }
  EXPECT_TRUE(table.Contains("b.length"));
  EXPECT_TRUE(table.Contains("Viewer.Size"));
  EXPECT_FALSE(table.Contains("b.lenght"));
}

TEST(OptionTable, EntriesAreSortedAndShowTheCurrentValues) {
  Fields fields;
  OptionTable table = fields.Bind();
  table.Set("b.count", "5", "test");
  const auto entries = table.Entries();
  ASSERT_EQ(entries.size(), 5U);
  EXPECT_EQ(entries[0].key, "a.seed");
  EXPECT_EQ(entries[1].key, "b.count");
  EXPECT_EQ(entries[1].value, "5");
  EXPECT_EQ(entries[1].expected, "an integer from 1 to 10");
  EXPECT_EQ(entries[1].help, "how many");
  EXPECT_EQ(entries[4].value, "fast");
}

TEST(OptionTable, AKeyCannotBeBoundTwice) {
  Fields fields;
  OptionTable table = fields.Bind();
  EXPECT_THROW(table.Add("flag", &fields.flag, "again"), CheckError);
}

TEST(OptionTable, OneKeyMaySetSeveralFieldsWithEqualDefaults) {
  double first = 1.0;
  double second = 1.0;
  double other = 2.0;
  OptionTable table;
  table.Add("both", std::vector<double*>{&first, &second}, Range::Positive(), "both");
  table.Set("both", "3", "test");
  EXPECT_EQ(first, 3.0);
  EXPECT_EQ(second, 3.0);
  EXPECT_THROW(table.Set("both", "0", "test"), InputError);
  EXPECT_EQ(table.Entries().front().value, "3");
  EXPECT_THROW(table.Add("all", std::vector<double*>{&first, &other}, Range::Positive(), "all"),
               CheckError);
}

TEST(OptionScope, NamesItsOptionsByTheirPath) {
  double length = 1.0;
  double width = 1.0;
  double both = 1.0;
  bool flag = false;
  std::string text = "a";
  enum class Colour { kRed, kGreen };
  Colour colour = Colour::kRed;
  OptionTable table;
  const OptionScope outer(table, "outer");
  const OptionScope inner = outer.Inner("inner");
  inner.Add("length", &length, Range::Positive(), "length, m");
  inner.Add("width", &width, Range::Positive(), "width, m");
  inner.AddShared("size", {"length", "width"}, "length and width, m");
  outer.Add("both", {&both, &both}, Range::Positive(), "both");
  outer.Add("flag", &flag, "whether");
  outer.AddText("text", &text, "any");
  outer.AddEnum("colour", &colour, {"red", "green"}, "of the wall");
  std::vector<std::string> keys;
  for (const OptionTable::Entry& entry : table.Entries()) {
    keys.push_back(entry.key);
  }
  EXPECT_EQ(keys, (std::vector<std::string>{"outer.both", "outer.colour", "outer.flag",
                                            "outer.inner.length", "outer.inner.size",
                                            "outer.inner.width", "outer.text"}));
  table.Set("outer.inner.size", "3", "test");
  EXPECT_EQ(width, 3.0);
}

TEST(OptionTable, TextIsStoredUnchanged) {
  std::string field = "person";
  OptionTable table;
  table.AddText("classes", &field, "names");
  table.Set("classes", "person, potted plant", "test");
  EXPECT_EQ(field, "person, potted plant");
  table.Set("classes", "", "test");
  EXPECT_EQ(table.Entries().front().value, "");
}

}  // namespace
}  // namespace hullslam
