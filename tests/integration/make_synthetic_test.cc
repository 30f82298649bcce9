// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// Exit code of make_synthetic with the given arguments.
int ExitCode(const std::string& arguments) {
  const std::string command =
      std::string(HULLSLAM_BIN_DIR) + "/make_synthetic " + arguments + " > /dev/null 2>&1";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(MakeSynthetic, ExitCodesTellUsageFromSuccess) {
  const fs::path out = fs::path(testing::TempDir()) / "make_synthetic_cli";
  fs::remove_all(out);
  EXPECT_EQ(ExitCode("--help"), 0);
  EXPECT_EQ(ExitCode(""), 2);
  EXPECT_EQ(ExitCode(out.string() + " --scene kitchen"), 2);
  EXPECT_EQ(ExitCode(out.string() + " --frames 0"), 2);
  EXPECT_EQ(ExitCode(out.string() + " --frames many"), 2);
  EXPECT_EQ(ExitCode(out.string() + " --colour"), 2);
  EXPECT_FALSE(fs::exists(out));
  EXPECT_EQ(ExitCode(out.string() + " --frames 1"), 0);
  EXPECT_TRUE(fs::exists(out / "groundtruth_objects.json"));
  EXPECT_EQ(ExitCode(out.string() + " --frames 1"), 2);
  EXPECT_EQ(ExitCode(out.string() + " --frames 1 --force --quiet"), 0);
  fs::remove_all(out);
}

}  // namespace
}  // namespace hullslam
