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
  for (const char* const bad : {"", "{}", "['a']", "{1: 'a'}", "{0: 'a', 2: 'b'}", "{0: 'a",
                                "{0: a}", "{0: ''}", "{0: 'a' 1"}) {
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

}  // namespace
}  // namespace hullslam
