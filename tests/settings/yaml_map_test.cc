// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/yaml_map.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

class YamlMaps : public ::testing::Test {
 protected:
  YamlMap Read(const std::string& text) { return {folder_.Write("c.yaml", text), "a calibration"}; }

  TemporaryFolder folder_;
};

TEST_F(YamlMaps, GiveTextsNumbersListsAndMaps) {
  const YamlMap map = Read(
      "# comment\nmodel: pinhole\nfps: 30.0\nsize: [640, 480]\n"
      "pose: {data: [1, 2e-1]}\n");
  EXPECT_EQ(map.Text("model"), "pinhole");
  EXPECT_EQ(map.Number("fps"), 30.0);
  EXPECT_EQ(map.Numbers("size", 2, "width height"), (std::vector<double>{640.0, 480.0}));
  EXPECT_EQ(map.Map("pose").Numbers("data", 2, "a b"), (std::vector<double>{1.0, 0.2}));
  EXPECT_TRUE(map.Has("fps"));
  EXPECT_FALSE(map.Has("FPS"));
  EXPECT_EQ(map.Pixels("size", 640.0), 640);
}

TEST_F(YamlMaps, WhatIsMissingOrOfAnotherKindIsNamedWithItsLine) {
  const YamlMap map =
      Read("model: [a]\nfps: \"30\"\nsize: [640, wide]\nempty:\nbig: 1e12\nnan: .nan\n");
  ExpectInputError([&] { map.Number("rate"); }, {"c.yaml", "rate is not given, expected a calib"});
  ExpectInputError([&] { map.Number("empty"); }, {"empty is not given"});
  ExpectInputError([&] { map.Text("model"); }, {"c.yaml:1: model", "expected a name"});
  ExpectInputError([&] { map.Number("fps"); }, {"c.yaml:2: fps", "not a number", "'30'"});
  ExpectInputError([&] { map.Numbers("size", 2, "w h"); }, {"c.yaml:3: size", "'wide'"});
  ExpectInputError([&] { map.Numbers("size", 3, "a b c"); }, {"2 value(s), expected 3", "a b c"});
  ExpectInputError([&] { map.Numbers("fps", 3, "a b c"); }, {"1 value(s), expected 3"});
  ExpectInputError([&] { map.Number("big"); }, {"c.yaml:5: big", "reasonable size"});
  ExpectInputError([&] { map.Number("nan"); }, {"c.yaml:6: nan"});
  ExpectInputError([&] { map.Map("model"); }, {"c.yaml:1: model is not a map"});
  ExpectInputError([&] { map.Pixels("size", 0.5); }, {"c.yaml:3: size has the value '0.5'"});
  const YamlMap outer = Read("pose:\n  data: [1]\n");
  ExpectInputError([&] { outer.Map("pose").Numbers("data", 2, "a b"); },
                   {"c.yaml:2: pose.data has 1 value(s), expected 2"});
}

TEST_F(YamlMaps, FilesWithoutAMapAreRefused) {
  for (const char* const text : {"", "- 1\n- 2\n", "some text\n", "%YAML:1.0\n---\n"}) {
    ExpectInputError([&] { Read(text); }, {"c.yaml", "has no keys, expected a calibration"});
  }
  ExpectInputError([&] { Read("a: \"1\nb: 2\n"); }, {"c.yaml:2", "is not valid YAML"});
  ExpectInputError([&] { Read("a: [1\nb: 2\n"); }, {"c.yaml:", "is not valid YAML"});
  ExpectInputError([&] { Read(std::string("a\0b: 1\n", 7)); }, {"c.yaml", "not a text file"});
}

TEST_F(YamlMaps, TheFormsOfOpenCvAndOrbSlam2AreRead) {
  const YamlMap map = Read(
      "%YAML:1.0\n---\nViewer.PointSize:2\nm: !!opencv-matrix\n   rows: 1\n"
      "   data:[ 1., 2. ]\nurl: a:b\n");
  EXPECT_EQ(map.Number("Viewer.PointSize"), 2.0);
  EXPECT_EQ(map.Map("m").Numbers("data", 2, "a b"), (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(map.Text("url"), "a:b");
}

// Many names of one value must not be written out: a file of this kind stands for 10^9 values.
TEST_F(YamlMaps, ReferencesAreNotExpanded) {
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 9; ++i) {
    const std::string last = "*a" + std::to_string(i - 1) + " ";
    const std::string name = "a" + std::to_string(i);
    text += name + ": &" + name + " [" + last;
    for (int k = 1; k < 10; ++k) {
      text += ", " + last;
    }
    text += "]\n";
  }
  ExpectInputError([&] { Read(text).Numbers("a8", 10, "ten"); }, {"c.yaml", "not a number"});
}

}  // namespace
}  // namespace hullslam
