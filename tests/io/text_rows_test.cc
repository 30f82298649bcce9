// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/text_rows.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

TEST(TextRows, SkipsCommentsAndBlankLinesButCountsThem) {
  const TemporaryFolder folder;
  const auto path = folder.Write("a.txt", "# head\r\n\r\n1 two,3\t4\r\n   # indented\n 5\n\n6");
  std::vector<std::string> seen;
  ForEachRow(path, [&](const TextRow& row) {
    std::string text = std::to_string(row.line);
    for (const std::string_view column : row.columns) {
      text += '|' + std::string(column);
    }
    seen.push_back(text);
  });
  EXPECT_EQ(seen, (std::vector<std::string>{"3|1|two|3|4", "5|5", "7|6"}));
}

TEST(TextRows, NumbersAreFiniteAndFillTheirColumn) {
  double value = 0.0;
  EXPECT_TRUE(ParseFinite("-1.5e3", value));
  EXPECT_EQ(value, -1500.0);
  EXPECT_TRUE(ParseFinite("+2", value));
  for (const char* text : {"", "nan", "inf", "-inf", "1e999", "1.5x", "0x10", "abc", "+"}) {
    EXPECT_FALSE(ParseFinite(text, value)) << text;
  }
}

TEST(TextRows, ErrorsReportFileLineAndColumn) {
  const TemporaryFolder folder;
  const auto path = folder.Write("bad.txt", "1\n# comment\nn\x01m\n");
  const auto read = [&] {
    ForEachRow(path, [](const TextRow& row) { row.Number(0, "timestamp"); });
  };
  ExpectInputError(read, {"bad.txt:3: ", "timestamp is 'n?m'", "finite number"});
}

TEST(TextRows, UnreadableFilesAreReportedByName) {
  const TemporaryFolder folder;
  const auto file = folder.Write("file", "x");
  const auto missing = folder.path() / "none.txt";
  ExpectInputError([&] { ReadFile(missing); }, {missing.string(), "No such file"});
  ExpectInputError([&] { ReadFile(folder.path()); }, {folder.path().string(), "is a folder"});
  ExpectInputError([&] { ReadFile(file / "below"); }, {"file/below", "Not a directory"});
}

TEST(TextRows, ReadsAllBytes) {
  const TemporaryFolder folder;
  const std::string bytes("a\0b\r\n", 5);
  EXPECT_EQ(ReadFile(folder.Write("bytes", bytes)), bytes);
  EXPECT_EQ(ReadFile(folder.Write("empty", "")), "");
}

}  // namespace
}  // namespace hullslam
