// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/mask_classes.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

TEST(MaskClasses, HasEightyDifferentClasses) {
  const std::set<std::string> names(CocoClasses().begin(), CocoClasses().end());
  EXPECT_EQ(CocoClasses().size(), 80U);
  EXPECT_EQ(names.size(), 80U);
  EXPECT_EQ(CocoClasses()[41], "cup");
  EXPECT_EQ(CocoClasses()[62], "tv");
}

TEST(MaskClasses, CategoriesAreTheClassesNumberedWithGaps) {
  std::vector<std::string> names;
  for (int id = -1; id <= 100; ++id) {
    if (const auto name = CocoCategory(id)) {
      names.push_back(*name);
    }
  }
  EXPECT_EQ(names, CocoClasses());
  EXPECT_EQ(CocoCategory(1), "person");
  EXPECT_EQ(CocoCategory(47), "cup");
  EXPECT_EQ(CocoCategory(72), "tv");
  EXPECT_EQ(CocoCategory(90), "toothbrush");
  for (const int gap : {0, 12, 26, 29, 30, 45, 66, 68, 69, 71, 83, 91}) {
    EXPECT_FALSE(CocoCategory(gap).has_value()) << gap;
  }
}

TEST(MaskClasses, AFileReplacesTheNames) {
  const TemporaryFolder folder;
  EXPECT_EQ(ReadClasses(folder.path()), CocoClasses());
  folder.Write("classes.txt", " robot \r\nred ball\n\n\n");
  EXPECT_EQ(ReadClasses(folder.path()), (std::vector<std::string>{"robot", "red ball"}));
  const std::string path = folder.Write("classes.txt", "\n");
  ExpectInputError([&] { ReadClasses(folder.path()); }, {path, "no names"});
  folder.Write("classes.txt", "robot\n\nball");
  ExpectInputError([&] { ReadClasses(folder.path()); }, {path + ":2: ", "class 1"});
  folder.Write("classes.txt", std::string(1'000'001, 'a'));
  ExpectInputError([&] { ReadClasses(folder.path()); }, {path, "1000001 bytes"});
}

// With a mark, the first class would have another name, so a person would be mapped as an object.
TEST(MaskClasses, NamesOfFilesOfWindowsAreTheSame) {
  const TemporaryFolder folder;
  const std::vector<std::string> names = {"person", "cup"};
  for (const std::string& text : {std::string("\xef\xbb\xbfperson\r\ncup\r\n"),
                                  std::string("\xff\xfep\0e\0r\0s\0o\0n\0\n\0c\0u\0p\0", 22)}) {
    folder.Write("classes.txt", text);
    EXPECT_EQ(ReadClasses(folder.path()), names);
  }
  const std::string path = folder.Write("classes.txt", "person\nm\xfcslischale\n");
  ExpectInputError([&] { ReadClasses(folder.path()); }, {path + ":2: 'm?slischale' is not UTF-8"});
}

}  // namespace
}  // namespace hullslam
