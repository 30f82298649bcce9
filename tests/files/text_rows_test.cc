// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/text_rows.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/comma_locale.h"
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

std::vector<std::string> RowsOf(const std::filesystem::path& path) {
  std::vector<std::string> rows;
  ForEachRow(path, [&](const TextRow& row) {
    std::string text = std::to_string(row.line);
    for (const std::string_view column : row.columns) {
      text += '|' + std::string(column);
    }
    rows.push_back(text);
  });
  return rows;
}

TEST(TextRows, TheDecimalPointOfTheProgramDoesNotMatter) {
  const TemporaryFolder folder;
  const CommaLocale comma;
  ForEachRow(folder.Write("a.txt", "1234.5 -2.5e-3\n"), [](const TextRow& row) {
    EXPECT_EQ(row.Number(0, "a"), 1234.5);
    EXPECT_EQ(row.Number(1, "b"), -2.5e-3);
  });
}

TEST(TextRows, AListOfNumbersHasAllOfThemAndNothingElse) {
  Eigen::Vector3d values;
  EXPECT_TRUE(ParseFinites(" 1.5 -2\t3e2", values));
  EXPECT_EQ(values, Eigen::Vector3d(1.5, -2.0, 300.0));
  for (const char* const text : {"", "1 2", "1 2 3 4", "1 2 x", "1 2 nan", "1 2 3x"}) {
    EXPECT_FALSE(ParseFinites(text, values)) << text;
  }
}

// Spreadsheets and scripts write a line with the names of the columns, with or without a mark.
TEST(TextRows, AFirstLineOfNamesIsNoData) {
  const TemporaryFolder folder;
  const std::vector<std::string> rows = {"2|1|a.png", "3|2|b.png"};
  EXPECT_EQ(RowsOf(folder.Write("a.txt", "timestamp filename\n1 a.png\n2 b.png\n")), rows);
  EXPECT_EQ(RowsOf(folder.Write("b.txt", "\xef\xbb\xbf# colour\r\n1;a.png\r\n2;b.png\r\n")), rows);
  EXPECT_EQ(RowsOf(folder.Write("c.txt", "% stamp, file\n1, a.png\n2,\tb.png\n")), rows);
  // Neither a line with a number nor a later line is a line of names.
  EXPECT_EQ(RowsOf(folder.Write("d.txt", "nan a\nx y\n")).size(), 2U);
  ForEachRow(folder.Write("e.txt", "#old\nts (ns),tx (m)\n1,2\n"),
             [](const TextRow& row) { EXPECT_EQ(row.header, "ts (ns),tx (m)"); });
}

TEST(TextRows, DecimalCommasAreNamed) {
  const TemporaryFolder folder;
  const auto path = folder.Write("gt.txt", "1,5;2,5\n");
  ExpectInputError([&] { RowsOf(path); }, {"gt.txt:1: ", "decimal commas", "decimal points"});
  EXPECT_EQ(RowsOf(folder.Write("gt.txt", "# rotated, aligned; no truth\n1 2\n")).size(), 1u)
      << "a comment may have any text";
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

TEST(TextRows, LimitsAreReported) {
  const TemporaryFolder folder;
  const auto long_line = folder.Write("long.txt", "1\n" + std::string(1'000'001, '1') + "\n");
  const auto visit = [](const TextRow&) {};
  ExpectInputError([&] { ForEachRow(long_line, visit); },
                   {"long.txt:2: a line of 1000001 bytes, expected at most 1 MB"});
  ExpectInputError([&] { ForEachRow(long_line, visit, 1'000'000); },
                   {"long.txt: 1000004 bytes, expected at most 1 MB"});
  const auto huge = folder.Write("huge.txt", "");
  std::filesystem::resize_file(huge, 1'000'000'000);
  ExpectInputError([&] { ForEachRow(huge, visit); }, {"huge.txt: 1000000000 bytes"});
}

// What comes after such a byte would be missing in messages.
TEST(TextRows, ABinaryFileIsRefused) {
  const TemporaryFolder folder;
  const auto path = folder.Write("rgb.txt", std::string("1 a.png\n2 b\0c.png\n", 19));
  ExpectInputError([&] { ForEachRow(path, [](const TextRow&) {}); },
                   {"rgb.txt:2: ", "byte that is 0"});
}

TEST(TextRows, NumbersAndStampsHaveBounds) {
  const TemporaryFolder folder;
  const auto path = folder.Write("row.txt", "-5 1e12\n");
  ForEachRow(path, [](const TextRow& row) {
    EXPECT_EQ(row.Number(0, "x", 5.0), -5.0);
    EXPECT_EQ(row.Stamp(0), -5.0);
    ExpectInputError([&] { row.Number(0, "x", 4.0); }, {"row.txt:1: x is '-5'", "from -4 to 4"});
    ExpectInputError([&] { row.Stamp(1); }, {"row.txt:1: timestamp is '1e12'", "seconds"});
  });
}

TEST(TextRows, RotationsAreNormalised) {
  const TemporaryFolder folder;
  ForEachRow(folder.Write("row.txt", "0 0 0.2 0\n"), [](const TextRow& row) {
    const Eigen::Quaterniond rotation = row.Rotation(3, 0, 1, 2);
    EXPECT_EQ(rotation.coeffs(), Eigen::Vector4d(0.0, 0.0, 1.0, 0.0));
    EXPECT_EQ(row.Rotation(2, 0, 1, 3).coeffs(), Eigen::Vector4d(0.0, 0.0, 0.0, 1.0));
  });
  ForEachRow(folder.Write("bad.txt", "0 0 0 x\n"), [](const TextRow& row) {
    ExpectInputError([&] { row.Rotation(0, 1, 2, 2); }, {"bad.txt:1", "length 0"});
    ExpectInputError([&] { row.Rotation(3, 0, 1, 2); }, {"bad.txt:1", "qw is 'x'"});
  });
}

}  // namespace
}  // namespace hullslam
