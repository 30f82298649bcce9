// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "support/expect_error.h"
#include "support/paths.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

TEST(CanonicalPath, HasNoDotsLinksAndSlashAtTheEnd) {
  const TemporaryFolder folder;
  const fs::path top = fs::canonical(folder.path());
  folder.Write("desk/rgb.txt", "");
  fs::create_directory_symlink("desk", folder.path() / "link");
  EXPECT_EQ(CanonicalPath(folder.path() / "link/"), top / "desk");
  EXPECT_EQ(CanonicalPath(folder.path() / "desk/../desk/./rgb.txt"), top / "desk/rgb.txt");
  EXPECT_EQ(CanonicalPath(folder.path() / "link/new/file"), top / "desk/new/file");
  EXPECT_EQ(CanonicalPath("new"), fs::current_path() / "new");
}

TEST(IsSameOrInside, AcceptsTheFolderAndWhatIsInIt) {
  const TemporaryFolder folder;
  const fs::path desk = folder.path() / "desk";
  EXPECT_TRUE(IsSameOrInside(desk, desk / ""));
  EXPECT_TRUE(IsSameOrInside(desk / "a/b", desk));
  EXPECT_TRUE(IsSameOrInside(desk / "../desk/a", desk));
  EXPECT_FALSE(IsSameOrInside(folder.path(), desk));
  EXPECT_FALSE(IsSameOrInside(folder.path() / "desk2", desk));
  EXPECT_FALSE(IsSameOrInside(desk / "../a", desk));
}

// That an installation which was moved finds its own data is shown by the test "consumer".
TEST(DataPath, IsInTheSourceTreeWithoutAnInstallation) {
  EXPECT_TRUE(std::filesystem::equivalent(FindData("config", ""), SourceFolder() / "config"));
}

TEST(DataPath, AnErrorNamesAllPlacesAndTheHint) {
  ExpectInputError([] { FindData("no_such_data", "give --data FILE"); },
                   {"share/hullslam/no_such_data", (SourceFolder() / "no_such_data").string(),
                    "give --data FILE"});
}

TEST(NaturalOrder, ComparesNumbersByValue) {
  const std::vector<std::string> ordered = {
      "",       "1.png",    "2.png",     "10.png",     "99999999999999999999999.png",
      "a",      "a1b2.png", "a1b10.png", "a01b11.png", "a2b1.png",
      "frame2", "frame10",  "frame10a",  "frames"};
  for (size_t i = 0; i < ordered.size(); ++i) {
    for (size_t j = 0; j < ordered.size(); ++j) {
      EXPECT_EQ(IsNaturallyBefore(ordered[i], ordered[j]), i < j)
          << ordered[i] << " and " << ordered[j];
    }
  }
}

TEST(NaturalOrder, LeadingZerosDecideLast) {
  EXPECT_TRUE(IsNaturallyBefore("f01", "f1"));
  EXPECT_FALSE(IsNaturallyBefore("f1", "f01"));
  EXPECT_TRUE(IsNaturallyBefore("f1a", "f01b"));
  EXPECT_TRUE(IsNaturallyBefore("0", "00") != IsNaturallyBefore("00", "0"));
}

}  // namespace

}  // namespace hullslam
