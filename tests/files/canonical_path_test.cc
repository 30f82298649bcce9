// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/canonical_path.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace hullslam
