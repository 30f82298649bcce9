// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/text.h"

#include <gtest/gtest.h>

#include <cctype>
#include <set>
#include <string>

namespace hullslam {
namespace {

// The locale of this test is "C". So the functions of the standard are right for ASCII.
TEST(AsciiTest, EachCharacterIsWhatItIsInTheLocaleC) {
  for (int code = 0; code < 128; ++code) {
    const char c = static_cast<char>(code);
    EXPECT_EQ(IsDigit(c), std::isdigit(code) != 0) << code;
    EXPECT_EQ(IsLetter(c), std::isalpha(code) != 0) << code;
    EXPECT_EQ(IsBlank(c), std::isspace(code) != 0) << code;
    EXPECT_EQ(IsControl(c), std::iscntrl(code) != 0) << code;
  }
}

TEST(AsciiTest, OtherBytesAreNothing) {
  for (int code = 128; code < 256; ++code) {
    const char c = static_cast<char>(code);
    EXPECT_FALSE(IsDigit(c) || IsLetter(c) || IsBlank(c) || IsControl(c)) << code;
  }
}

TEST(LowerCase, ChangesTheLettersFromAToZOnly) {
  EXPECT_EQ(LowerCase("Freiburg1_XYZ [@`{].PNG"), "freiburg1_xyz [@`{].png");
  EXPECT_EQ(LowerCase("\xC3\x84pfel, \xC4"), "\xC3\x84pfel, \xC4");  // in UTF-8 and in Latin-1
  EXPECT_EQ(LowerCase(""), "");
}

TEST(LowerCase, TwiceIsOnce) {
  std::string all;
  for (int c = 0; c < 256; ++c) {
    all += static_cast<char>(c);
  }
  const std::string once = LowerCase(all);
  EXPECT_EQ(LowerCase(once), once);
  EXPECT_EQ(once.size(), all.size());
}

TEST(Trim, RemovesBlanksAtBothEndsOnly) {
  EXPECT_EQ(Trim(" \t potted plant\r"), "potted plant");
  EXPECT_EQ(Trim("cup"), "cup");
  EXPECT_EQ(Trim(" \t\r"), "");
  EXPECT_EQ(Trim(""), "");
}

TEST(SplitNames, TakesBlanksOffAndLeavesEmptyOnesOut) {
  EXPECT_EQ(SplitNames("person"), std::set<std::string>{"person"});
  EXPECT_EQ(SplitNames(" person , potted plant,,"),
            (std::set<std::string>{"person", "potted plant"}));
  EXPECT_TRUE(SplitNames("").empty());
  EXPECT_TRUE(SplitNames(" ").empty());
}

TEST(ShownText, ShortPrintableTextsAreShownAsTheyAre) {
  EXPECT_EQ(ShowText("Camera.fx"), "Camera.fx");
  EXPECT_EQ(ShowText("abcd", 4), "abcd");
}

TEST(ShownText, LongTextsAreCutAndOtherBytesReplaced) {
  EXPECT_EQ(ShowText("abcde", 4), "abcd...");
  EXPECT_EQ(ShowText("a\n\x01\xc3\xa9z"), "a????z");
  EXPECT_EQ(ShowText(std::string(900'000, 'a')).size(), 123U);
}

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

TEST(Counted, OnlyOneIsSingular) {
  EXPECT_EQ(Counted(0, "keyframe"), "0 keyframes");
  EXPECT_EQ(Counted(1, "keyframe"), "1 keyframe");
  EXPECT_EQ(Counted(21, "image"), "21 images");
}

TEST(EditDistance, CountsInsertedRemovedAndReplacedCharacters) {
  EXPECT_EQ(EditDistance("voom", "voom"), 0u);
  EXPECT_EQ(EditDistance("vom", "voom"), 1u);
  EXPECT_EQ(EditDistance("voom", "vom"), 1u);
  EXPECT_EQ(EditDistance("orbslam2", "orb_slam2"), 1u);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3u);
}

TEST(EditDistance, TheEmptyTextNeedsAllCharacters) {
  EXPECT_EQ(EditDistance("", ""), 0u);
  EXPECT_EQ(EditDistance("", "abc"), 3u);
  EXPECT_EQ(EditDistance("abc", ""), 3u);
}

TEST(EditDistance, AMisspeltNameIsSimilarAndDiffersNotOnlyInNumbers) {
  EXPECT_TRUE(IsMisspelt("Camera.fxx", "Camera.fx"));
  EXPECT_TRUE(IsMisspelt("objects.start.min_view", "objects.start.min_views"));
  EXPECT_TRUE(IsMisspelt("lenght", "length"));
  EXPECT_FALSE(IsMisspelt("PointCloudMapping.Resolution", "objects.start.inflation"));
  EXPECT_FALSE(IsMisspelt("is", "tv"));
  EXPECT_FALSE(IsMisspelt("my", "cup"));
  EXPECT_TRUE(IsMisspelt("boat", "book"));
  EXPECT_FALSE(IsMisspelt("Camera.k4", "Camera.bf"));
  EXPECT_FALSE(IsMisspelt("Camera.k4", "Camera.k1"));
  EXPECT_FALSE(IsMisspelt("Camera2.fx", "Camera.fx"));
}

TEST(EditDistance, IsSymmetric) {
  EXPECT_EQ(EditDistance("quadric", "quartic"), EditDistance("quartic", "quadric"));
}

}  // namespace

}  // namespace hullslam
