// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/read_text.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

using namespace std::string_view_literals;

// "1 \u00e9\n\U0001f600\r\n" in all encodings.
constexpr std::string_view kText = "1 \xc3\xa9\n\xf0\x9f\x98\x80\r\n";
constexpr std::string_view kLittle = "1\0 \0\xe9\0\n\0\x3d\xd8\x00\xde\r\0\n\0"sv;

std::string SwapBytes(std::string_view text) {
  std::string swapped(text);
  for (size_t i = 0; i + 1 < swapped.size(); i += 2) {
    std::swap(swapped[i], swapped[i + 1]);
  }
  return swapped;
}

TEST(ReadText, AllEncodingsOfWindowsGiveTheSameText) {
  const TemporaryFolder folder;
  const std::string big = SwapBytes(kLittle);
  for (const std::string& bytes :
       {std::string(kText), "\xef\xbb\xbf" + std::string(kText), "\xff\xfe" + std::string(kLittle),
        "\xfe\xff" + big, std::string(kLittle), big}) {
    EXPECT_EQ(ReadText(folder.Write("a.txt", bytes)), kText);
  }
}

TEST(ReadText, OtherBytesStayAsTheyAre) {
  const TemporaryFolder folder;
  for (const std::string_view bytes : {""sv, "a"sv, "\0"sv, "1 B\xfcro.png\n"sv, "a\0b\n"sv}) {
    EXPECT_EQ(ReadText(folder.Write("a.txt", bytes)), bytes);
  }
  EXPECT_EQ(ReadText(folder.Write("a.txt", "1\r2\r")), "1\n2\n");
}

TEST(ReadText, WhatIsNoTextIsNamed) {
  const TemporaryFolder folder;
  const auto read = [&](std::string_view bytes) {
    return [&folder, bytes] { ReadText(folder.Write("a.txt", bytes)); };
  };
  ExpectInputError(read("\xff\xfe\0\0a\0\0\0"sv), {"a.txt: is text in UTF-32"});
  ExpectInputError(read("\0\0\xfe\xff\0\0\0a"sv), {"a.txt: is text in UTF-32"});
  ExpectInputError(read("\xff\xfe"
                        "a\0b"sv),
                   {"a.txt: ", "half a character at byte 2"});
  ExpectInputError(read("\xff\xfe\x3d\xd8"
                        "a\0"sv),
                   {"half a character at byte 0"});
  ExpectInputError(read("\xff\xfe\x00\xde"
                        "a\0"sv),
                   {"half a character at byte 0"});
}

TEST(ReadText, EightBitEncodingsAreNamed) {
  CheckUtf8("a.txt", kText);
  ExpectInputError([] { CheckUtf8("a.txt", "cup\nB\xfcro\n"); },
                   {"a.txt:2: 'B?ro' is not UTF-8", "saved as UTF-8"});
}

TEST(LinesOf, EachEndsAtItsNewline) {
  using Lines = std::vector<std::string_view>;
  EXPECT_EQ(LinesOf(""), Lines());
  EXPECT_EQ(LinesOf("a"), Lines({"a"}));
  EXPECT_EQ(LinesOf("a\n"), Lines({"a"}));
  EXPECT_EQ(LinesOf("\na\r\n\nb"), Lines({"", "a\r", "", "b"}));
}

}  // namespace
}  // namespace hullslam
