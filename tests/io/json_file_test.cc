// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/json_file.h"

#include <gtest/gtest.h>

#include <string>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

TEST(JsonFile, IsParsed) {
  const TemporaryFolder folder;
  EXPECT_EQ(ReadJson(folder.Write("f.json", "{\"a\": [1, 2]}"))["a"][1], 2);
}

TEST(JsonFile, InvalidFilesAreReportedWithLineAndColumn) {
  const TemporaryFolder folder;
  const auto expect = [&](const char* content, const char* place) {
    const auto path = folder.Write("bad.json", content);
    ExpectInputError([&] { ReadJson(path); }, {"bad.json: is no valid JSON", place});
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
  ExpectInputError([&] { ReadJson(path, 5); }, {"file.json: 9 bytes"});
}

TEST(JsonFile, MessagesShowValuesInAsciiAndShortened) {
  EXPECT_EQ(ShowJson("a\n\xc3\xa9"), "\"a\\n\\u00e9\"");
  EXPECT_LT(ShowJson(std::string(1'000'000, 'a')).size(), 200U);
}

}  // namespace
}  // namespace hullslam
