// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/yaml_settings.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

class YamlSettings : public ::testing::Test {
 protected:
  std::vector<WrittenSetting> Read(const std::string& lines) {
    return ReadYamlSettings(folder_.Write("a.yaml", "%YAML:1.0\n" + lines));
  }

  TemporaryFolder folder_;
};

TEST_F(YamlSettings, AreInTheOrderOfTheFileWithTheirLines) {
  const auto settings = Read("# a comment\nb: 1.5  # px\n\na: some text\n");
  ASSERT_EQ(settings.size(), 2u);
  EXPECT_EQ(settings[0].key, "b");
  EXPECT_EQ(settings[0].name, "b");
  EXPECT_EQ(settings[0].text, "1.5");
  EXPECT_EQ(settings[0].origin, (folder_.path() / "a.yaml").string() + ":3");
  EXPECT_EQ(settings[1].key, "a");
  EXPECT_EQ(settings[1].text, "some text");
}

TEST_F(YamlSettings, ACommentMayFollowAText) {
  const auto settings =
      Read("a: some text  # [1]: as 'here', \"there\"\nb: c#d\ne: \"f # g\"\n#h: 1\n");
  ASSERT_EQ(settings.size(), 3u);
  EXPECT_EQ(settings[0].text, "some text");
  EXPECT_EQ(settings[1].text, "c#d");
  EXPECT_EQ(settings[2].text, "f # g");
  EXPECT_EQ(settings[2].origin, (folder_.path() / "a.yaml").string() + ":4");
}

TEST_F(YamlSettings, NumbersKeepTheirDigitsAndQuotes) {
  const auto settings = Read("a: 12345678901\nb: 1000.\nc: 1e3\nd: \"7\"\ne: 0.1\n");
  ASSERT_EQ(settings.size(), 5u);
  EXPECT_EQ(settings[0].text, "12345678901");
  EXPECT_EQ(settings[1].text, "1000");
  EXPECT_EQ(settings[2].text, "1000");
  EXPECT_EQ(settings[3].text, "\"7\"");
  EXPECT_EQ(settings[4].text, "0.1");
}

TEST_F(YamlSettings, OnlySingleValuesHaveAText) {
  const auto settings = Read("a: [1, 2]\nb: {c: 1}\nd:\n");
  ASSERT_EQ(settings.size(), 3u);
  ExpectInputError([&] { SingleValue(settings[0]); }, {"a.yaml:2: a is a list", "single value"});
  ExpectInputError([&] { SingleValue(settings[1]); }, {"a.yaml:3: b is a map"});
  ExpectInputError([&] { SingleValue(settings[2]); }, {"a.yaml:4: d is empty"});
}

TEST_F(YamlSettings, AMapOfSingleValuesHasPairs) {
  const auto settings = Read(
      "a:\n  cup: 0.1\n  potted plant: 2\nb: {c: 1.5}\nd: {e: {f: 1}}\ng: {h: x}\ni: 1\nj: {}\n");
  ASSERT_EQ(settings.size(), 6u);
  EXPECT_EQ(settings[0].pairs, "cup:0.1,potted plant:2");
  EXPECT_EQ(settings[1].pairs, "c:1.5");
  EXPECT_FALSE(settings[2].pairs);
  EXPECT_EQ(settings[3].pairs, "h:x");
  EXPECT_FALSE(settings[4].pairs);
  EXPECT_EQ(settings[5].pairs, "");
}

TEST_F(YamlSettings, BrokenFilesAreRefused) {
  ExpectInputError([&] { Read("a: 1\na: 2\n"); }, {"a.yaml:3: key 'a' was given before", "line 2"});
  ExpectInputError([&] { Read("- 1\n- 2\n"); }, {"a.yaml: has no settings"});
  ExpectInputError([&] { ReadYamlSettings(folder_.Write("a.xml", "%YAML:1.0\n- 1\n")); },
                   {"a.xml", "a file .yml"});
  ExpectInputError([&] { Read("a: \"1\n"); }, {"a.yaml:2: "});
  ExpectInputError([&] { Read("[a, b]: 1\n"); }, {"a.yaml:2: expected 'key: value'"});
}

TEST_F(YamlSettings, TheFirstLineOfOpenCvIsNotNeeded) {
  const auto settings = ReadYamlSettings(folder_.Write("b.yaml", "a: 1\nb:2\n"));
  ASSERT_EQ(settings.size(), 2u);
  EXPECT_EQ(settings[0].origin, (folder_.path() / "b.yaml").string() + ":1");
  EXPECT_EQ(settings[1].text, "2");
}

}  // namespace
}  // namespace hullslam
