// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/staged_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <string>

#include "files/read_file.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

class StagedFileTest : public ::testing::Test {
 protected:
  std::string Content() const { return ReadFile(path_); }
  size_t FilesInFolder() const {
    return static_cast<size_t>(std::distance(fs::recursive_directory_iterator(folder_.path()), {}));
  }

  TemporaryFolder folder_;
  fs::path path_ = folder_.Write("result", "earlier");
};

TEST_F(StagedFileTest, ReplacesTheEarlierFileOnlyAsAWhole) {
  StagedFile file(path_);
  file.Write("first, ");
  EXPECT_EQ(Content(), "earlier");
  file.Write("second");
  EXPECT_EQ(Content(), "earlier");
  file.Commit();
  EXPECT_EQ(Content(), "first, second");
}

TEST_F(StagedFileTest, LeavesNothingBehind) {
  {
    StagedFile file(path_);
    file.Write("half");
  }
  EXPECT_EQ(Content(), "earlier");
  EXPECT_EQ(FilesInFolder(), 1u);
  {
    StagedFile file(path_);
    file.Commit();
  }
  EXPECT_EQ(Content(), "");
  EXPECT_EQ(FilesInFolder(), 1u);
}

TEST_F(StagedFileTest, AFolderThatIsMissingIsNamed) {
  ExpectInputError([&] { StagedFile(folder_.path() / "none" / "result"); }, {"none"});
}

}  // namespace
}  // namespace hullslam
