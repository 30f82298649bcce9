// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/json_file.h"

#include <gtest/gtest.h>

#include <string>

#include "support/comma_locale.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

TEST(JsonFile, IsParsed) {
  const TemporaryFolder folder;
  EXPECT_EQ(ReadJson(folder.Write("f.json", "{\"a\": [1, 2]}"))["a"][1], 2);
}

TEST(JsonFile, TheDecimalPointOfTheProgramDoesNotMatter) {
  const TemporaryFolder folder;
  const auto path = folder.Write("f.json", "[1.5, -2.25e-3, 1234.5]");
  for (const char* const point : {",", "<U066B>"}) {
    const CommaLocale locale(point);
    const nlohmann::json json = ReadJson(path);
    EXPECT_EQ(json[0], 1.5) << point;
    EXPECT_EQ(json[1], -2.25e-3) << point;
    EXPECT_EQ(json.dump(), "[1.5,-0.00225,1234.5]") << point;
  }
}

TEST(JsonFile, InvalidFilesAreReportedWithLineAndColumn) {
  const TemporaryFolder folder;
  const auto expect = [&](const char* content, const char* position) {
    const auto path = folder.Write("bad.json", content);
    ExpectInputError([&] { ReadJson(path); }, {"bad.json: is no valid JSON", position});
  };
  expect("", "line 1, column 1");
  expect("{\n", "line 2");
  expect("{\"a\": nan}", "line 1");
  expect(
      "\x7f"
      "ELF",
      "line 1");
  expect("[1e999]", "1e999");
}

TEST(JsonFile, UnreadableAndTooLargeFilesAreReported) {
  const TemporaryFolder folder;
  ExpectInputError([&] { ReadJson(folder.path() / "none.json"); }, {"none.json: No such file"});
  const auto path = folder.Write("file.json", "[1, 2, 3]");
  ExpectInputError([&] { ReadJson(path, {.most_bytes = 5}); }, {"file.json: 9 bytes"});
  ExpectInputError([&] { ReadJson(path, {.most_values = 4}); }, {"file.json: ", "4 values"});
}

// The library's dump() calls itself for each level and could overflow the stack, so deep values
// must be refused before they are built.
TEST(JsonFile, DeepNestingIsRefused) {
  const TemporaryFolder folder;
  for (const char* const opening : {"[", "{\"a\":"}) {
    std::string text;
    for (int i = 0; i < 200'000; ++i) {
      text += opening;
    }
    const auto path = folder.Write("deep.json", text);
    ExpectInputError([&] { ReadJson(path); }, {"deep.json: is nested more than 32 deep"});
  }
  const std::string allowed = std::string(32, '[') + std::string(32, ']');
  EXPECT_TRUE(ReadJson(folder.Write("allowed.json", allowed)).is_array());
}

TEST(JsonFile, MessagesShowOnlyTheBeginningOfLargeValues) {
  nlohmann::json deep;
  for (int i = 0; i < 100'000; ++i) {
    nlohmann::json outer = nlohmann::json::array();
    outer.push_back(std::move(deep));
    deep = std::move(outer);
  }
  EXPECT_EQ(ShowJson(deep), std::string(120, '[') + "...");
  EXPECT_EQ(ShowJson(nlohmann::json::parse(R"({"a": [1, 2.5, null], "b": {}})")),
            R"({"a":[1,2.5,null],"b":{}})");
}

TEST(JsonFile, MessagesShowValuesInAsciiAndShortened) {
  EXPECT_EQ(ShowJson("a\n\xc3\xa9"), "\"a\\n\\u00e9\"");
  EXPECT_LT(ShowJson(std::string(1'000'000, 'a')).size(), 200U);
}

}  // namespace
}  // namespace hullslam
