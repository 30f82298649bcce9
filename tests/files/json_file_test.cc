// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/json_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "support/comma_locale.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

TEST(ClassicLocaleTest, NumbersHavePointsWhileItExists) {
  const CommaLocale comma;
  {
    const ClassicLocale classic;
    EXPECT_EQ(std::strtod("1.5", nullptr), 1.5);
    {
      const ClassicLocale nested;
      EXPECT_EQ(std::strtod("1.5", nullptr), 1.5);
    }
    EXPECT_EQ(std::strtod("1.5", nullptr), 1.5);
  }
  EXPECT_EQ(std::strtod("1.5", nullptr), 1.0);
}

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

using Json = nlohmann::json;

class JsonNodeTest : public ::testing::Test {
 protected:
  // Expects that `read` fails on `text` with a message that contains all `parts`.
  template <typename Read>
  void ExpectRefusal(const char* text, const Read& read, const std::vector<std::string>& parts) {
    const Json json = Json::parse(text);
    ExpectInputError([&] { read(JsonNode(file_, json)); }, parts);
  }

  std::filesystem::path file_ = "f.json";
};

TEST_F(JsonNodeTest, TextsAreMadePrintable) {
  const Json json = Json::parse(R"(["a\u001b[2J\u0000\nb", "\u00e9"])");
  EXPECT_EQ(JsonNode(file_, json).Elements()[0].Text(), "a?[2J??b");
  EXPECT_EQ(JsonNode(file_, json).Elements()[1].Text(), "\xc3\xa9");
}

TEST_F(JsonNodeTest, ReturnsTheValues) {
  const Json json = Json::parse(R"({"b": [1, 2.5, -3], "a": {"t": "x", "f": true, "n": 7},
      "p": [[1, 2], [3, 4]], "null": null})");
  const JsonNode node(file_, json);
  EXPECT_EQ(node.At("a").At("t").Text(), "x");
  EXPECT_TRUE(node.At("a").At("f").Flag());
  EXPECT_EQ(node.At("a").At("n").Count(), 7U);
  EXPECT_EQ(node.At("a").At("n").PositiveNumber(7.0), 7.0);
  EXPECT_EQ(node.At("b").Numbers(3), (std::vector<double>{1.0, 2.5, -3.0}));
  EXPECT_EQ(node.At("b").Elements()[1].Number(), 2.5);
  EXPECT_EQ(node.At("p").Points()[1], Eigen::Vector2d(3, 4));
  EXPECT_EQ(node.Members()[0].first, "a");
  EXPECT_TRUE(node.Has("a"));
  EXPECT_FALSE(node.Has("null"));
  EXPECT_FALSE(node.Has("c"));
}

TEST_F(JsonNodeTest, ReportsThePathAndTheValue) {
  ExpectRefusal(R"({"a": [{"b": "x"}]})",
                [](const JsonNode& node) { node.At("a").Elements()[0].At("b").Number(); },
                {"f.json: a[0].b is \"x\"", "expected a finite number"});
  ExpectRefusal(R"({"a": [{}]})", [](const JsonNode& node) { node.At("a").Elements()[0].At("b"); },
                {"f.json: a[0]: \"b\" is missing"});
  ExpectRefusal("{}", [](const JsonNode& node) { node.At("b"); }, {"f.json: \"b\" is missing"});
  ExpectRefusal("[1]", [](const JsonNode& node) { node.At("b"); }, {"the top is [1]", "an object"});
}

TEST_F(JsonNodeTest, RefusesOtherTypes) {
  ExpectRefusal("1", [](const JsonNode& node) { node.Text(); }, {"a string"});
  ExpectRefusal("1", [](const JsonNode& node) { node.Flag(); }, {"true or false"});
  ExpectRefusal("1", [](const JsonNode& node) { node.Elements(); }, {"an array"});
  ExpectRefusal("1", [](const JsonNode& node) { node.Members(); }, {"an object"});
  ExpectRefusal("0", [](const JsonNode& node) { node.PositiveNumber(1e3); }, {"> 0"});
  ExpectRefusal("-1", [](const JsonNode& node) { node.Count(); }, {"is -1", "integer"});
  ExpectRefusal("1.5", [](const JsonNode& node) { node.Count(); }, {"is 1.5", "integer"});
  ExpectRefusal("4294967295", [](const JsonNode& node) { node.Count(); }, {"4294967294"});
  ExpectRefusal("[1, null]", [](const JsonNode& node) { node.Numbers(2); }, {"2 finite numbers"});
  ExpectRefusal("[1]", [](const JsonNode& node) { node.Numbers(2); }, {"2 finite numbers"});
  ExpectRefusal("[[1, 2], [3]]", [](const JsonNode& node) { node.Points(); }, {"points [x, y]"});
  ExpectRefusal("[[1e7, 2]]", [](const JsonNode& node) { node.Points(); }, {"1e+06 px"});
  ExpectRefusal("1e4", [](const JsonNode& node) { node.PositiveNumber(1e3); }, {"up to 1000"});
  ExpectRefusal("-1e4", [](const JsonNode& node) { node.Number(1e3); }, {"from -1000 to 1000"});
  ExpectRefusal("[1, 1e155, 1]", [](const JsonNode& node) { node.Lengths(); }, {"up to 1e+08 m"});
  ExpectRefusal("[1]", [](const JsonNode& node) { node.Numbers(2, "x, y"); }, {"expected x, y"});
}

TEST_F(JsonNodeTest, LongKeysAreCutInMessages) {
  const std::string text = "{\"" + std::string(900'000, 'k') + "\": 1}";
  ExpectRefusal(text.c_str(),
                [](const JsonNode& node) {
                  try {
                    node.Members()[0].second.Text();
                  } catch (const std::exception& error) {
                    EXPECT_LT(std::string(error.what()).size(), 200U);
                    throw;
                  }
                },
                {"kkk... is 1"});
}

TEST_F(JsonNodeTest, LongValuesAreCutInMessages) {
  const std::string text = "\"" + std::string(1000, 'x') + "\"";
  ExpectRefusal(text.c_str(),
                [](const JsonNode& node) {
                  try {
                    node.Number();
                  } catch (const std::exception& error) {
                    EXPECT_LT(std::string(error.what()).size(), 200U);
                    throw;
                  }
                },
                {"..."});
}

}  // namespace

}  // namespace hullslam
