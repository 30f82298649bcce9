// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/printable.h"

#include <gtest/gtest.h>

#include <string>

namespace hullslam {
namespace {

using namespace std::string_literals;

TEST(Printable, PrintableTextStaysAsItIs) {
  for (const char* const text : {"", "cup", "a/b c~.png", "12.5°", "tasse \xc3\xa9", "\xe6\x9d\xaf",
                                 "\xf0\x9f\x8d\xb5", "\xf4\x8f\xbf\xbf"}) {
    EXPECT_EQ(Printable(text), text);
  }
}

TEST(Printable, ControlCharactersAreReplaced) {
  EXPECT_EQ(Printable("a\x1b[2Jb"), "a?[2Jb");
  EXPECT_EQ(Printable("a\0b\r\n\t\x7f"s), "a?b????");
  EXPECT_EQ(Printable("\xc2\x9b 31m"), "? 31m") << "an escape sequence in one character";
  EXPECT_EQ(Printable("\xe2\x80\xae gnp.exe"), "? gnp.exe") << "written from right to left";
  EXPECT_EQ(Printable("a\xe2\x80\xa8"
                      "b"),
            "a?b")
      << "a line separator";
  EXPECT_EQ(Printable("a\nb\tc\x1b", "\n\t"), "a\nb\tc?");
}

TEST(Printable, BytesThatAreNotUtf8AreReplaced) {
  EXPECT_EQ(Printable("a\xff\xfe"
                      "b"),
            "a??b");
  EXPECT_EQ(Printable("a\x9b"
                      "b"),
            "a?b");
  EXPECT_EQ(Printable("a\xc3"), "a?") << "cut off";
  EXPECT_EQ(Printable("\xe2\x82z"), "??z");
  EXPECT_EQ(Printable("\xc0\xaf"), "??") << "longer than necessary";
  EXPECT_EQ(Printable("\xed\xa0\x80"), "???") << "a surrogate";
  EXPECT_EQ(Printable("\xf4\x90\x80\x80"), "????") << "beyond the last character";
}

}  // namespace
}  // namespace hullslam
