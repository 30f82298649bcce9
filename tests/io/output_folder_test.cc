// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/io/output_folder.h"

#include <gtest/gtest.h>

#include "io/text_rows.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

TEST(OutputFolder, IsCreatedWithItsParentsAndLeftEmpty) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a" / "b";
  PrepareOutputFolder(path);
  EXPECT_TRUE(std::filesystem::is_directory(path));
  EXPECT_TRUE(std::filesystem::is_empty(path));
}

TEST(OutputFolder, KeepsTheFilesOfAnExistingFolder) {
  const TemporaryFolder folder;
  const auto file = folder.Write("trajectory.txt", "of the last run");
  PrepareOutputFolder(folder.path());
  EXPECT_EQ(ReadFile(file), "of the last run");
}

TEST(OutputFolder, AnExistingFileIsReported) {
  const TemporaryFolder folder;
  const auto file = folder.Write("file", "x");
  ExpectInputError([&] { PrepareOutputFolder(file); }, {file.string()});
  ExpectInputError([&] { PrepareOutputFolder(file / "below"); }, {"file/below"});
  ExpectInputError([&] { PrepareOutputFolder("/proc/none"); }, {"/proc/none"});
  EXPECT_EQ(ReadFile(file), "x");
}

}  // namespace
}  // namespace hullslam
