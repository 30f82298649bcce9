// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/yaml_nesting.h"

#include <gtest/gtest.h>

#include <string>

#include "support/expect_error.h"

namespace hullslam {
namespace {

void ExpectAccepted(const std::string& text) {
  EXPECT_NO_THROW(CheckYamlNesting("f.yaml", text)) << text.substr(0, 100);
}

void ExpectRefused(const std::string& text, int line) {
  ExpectInputError([&] { CheckYamlNesting("f.yaml", text); },
                   {"f.yaml:" + std::to_string(line) + ": is nested too deep"});
}

TEST(YamlNesting, CommentsMatricesAndTextsAreAccepted) {
  ExpectAccepted("%YAML:1.0\n#" + std::string(1000, '-') + "\na: 1 # " + std::string(1000, '['));
  std::string matrix = "m: !!opencv-matrix\n   rows: 20\n   data: [";
  for (int i = 0; i < 400; ++i) {
    matrix += i % 20 == 0 ? "-1.5,\n        " : "-1.5, ";
  }
  ExpectAccepted(matrix + "]\n");
  ExpectAccepted("a: \"" + std::string(200, '[') + "\"\n" + std::string(1000, ' ') + "\n");
}

TEST(YamlNesting, ManyLevelsAreRefused) {
  ExpectRefused("a: 1\r\nb: " + std::string(501, '['), 2);
  ExpectRefused("a: 1\nb: 2\n- - " + std::string(201, '-'), 3);
  ExpectRefused("a: 1\n" + std::string(201, ' ') + "b: 2\n", 2);
  std::string lists = "a:\n";
  for (int i = 0; i < 501; ++i) {
    lists += "[\n";
  }
  ExpectRefused(lists, 502);
}

// Closing brackets and '#' inside quoted texts must not hide opening brackets.
TEST(YamlNesting, QuotedTextsHideNoLevels) {
  std::string lists = "a: ";
  for (int i = 0; i < 600; ++i) {
    lists += "[\"]\", ";
  }
  ExpectRefused(lists, 1);
  ExpectRefused("'#': " + std::string(501, '['), 1);
}

}  // namespace
}  // namespace hullslam
