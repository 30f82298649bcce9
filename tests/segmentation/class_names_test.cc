// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/class_names.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

using Names = std::vector<std::string>;

TEST(ClassNames, AreReadFromADictionaryOfPython) {
  EXPECT_EQ(ParseClassNames("{0: 'person', 1: \"driver's cab\", 2: 'it\\'s'}"),
            (Names{"person", "driver's cab", "it's"}));
  EXPECT_EQ(ParseClassNames("{0:'a'}"), Names{"a"});
  EXPECT_EQ(ParseClassNames("{'0': 'a', \"1\": 'b'}"), (Names{"a", "b"}));
  EXPECT_EQ(ParseClassNames(R"(["a", 'b'])"), (Names{"a", "b"}));
  EXPECT_EQ(ParseClassNames(R"({0: 'd\u00e9j\xe0', 1: '\U0001f3e0', 2: 'a\nb\\', 3: '\u00'})"),
            (Names{"d\xc3\xa9j\xc3\xa0", "\xf0\x9f\x8f\xa0", "a\nb\\", "u00"}));
  for (const char* const bad : {"", "{}", "[]", "['a'", "['a'}", "{'0x': 'a'}", "{1: 'a'}",
                                "{0: 'a', 2: 'b'}", "{0: 'a", "{0: a}", "{0: ''}", "{0: 'a' 1"}) {
    EXPECT_FALSE(ParseClassNames(bad)) << bad;
  }
}

TEST(ClassNames, AreReadFromAFile) {
  const TemporaryFolder folder;
  EXPECT_EQ(ReadClassNames(folder.Write("a.txt", "cup\r\ndining table\n\n")),
            (Names{"cup", "dining table"}));
  ExpectInputError([&] { ReadClassNames(folder.Write("b.txt", "cup\n\ntv\n")); },
                   {"b.txt:2", "is empty", "class 1"});
  ExpectInputError([&] { ReadClassNames(folder.Write("c.txt", "cup\ntv\ncup\n")); },
                   {"c.txt:3", "'cup'", "line 1"});
  ExpectInputError([&] { ReadClassNames(folder.Write("d.txt", " \n")); }, {"d.txt", "no names"});
}

// Each line of classes.txt is a class, so one more line feed would shift all classes behind it.
TEST(ClassNames, AreCheckedForWhatAFileOfNamesCannotHave) {
  EXPECT_NO_THROW(CheckClassNames("net", {"cup", "d\xc3\xa9j\xc3\xa0 vu", "a,b", "# c"}));
  for (const std::string bad :
       {"cup\nbook", "cup\rbook", " cup", "cup ", "a\tb", "\x1b[2J", "cup\xff\xfe",
        "\xef\xbb\xbf"
        "cup",
        "\xe2\x80\xa8", " ", ""}) {
    ExpectInputError([&] { CheckClassNames("net", {"tv", bad}); }, {"net: ", "class 1"});
  }
  ExpectInputError([&] { CheckClassNames("net", {"tv", std::string("a\0", 2)}); }, {"class 1"});
  ExpectInputError([&] { CheckClassNames("net", {"tv", "tv"}); }, {"net: ", "'tv'"});
  const TemporaryFolder folder;
  ExpectInputError([&] { ReadClassNames(folder.Write("e.txt", "tv\ncup\x1b[2J\n")); }, {"e.txt:2"});
}

}  // namespace
}  // namespace hullslam
