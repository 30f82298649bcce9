// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <vector>

#include "support/run_program.h"

namespace hullslam {
namespace {

class Help : public ::testing::TestWithParam<std::string> {};

TEST_P(Help, NamesTheExitCodes) {
  const ProgramResult result = RunProgram(GetParam(), {"--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.output.find("Exit codes: 0 "), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("--version"), std::string::npos) << result.output;
}

TEST_P(Help, TheVersionIsPrinted) {
  const ProgramResult result = RunProgram(GetParam(), {"--version"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  EXPECT_TRUE(std::isdigit(static_cast<unsigned char>(result.output[0]))) << result.output;
  EXPECT_NE(result.output.find('.'), std::string::npos) << result.output;
}

// All programs; the others of the folder are examples of the library, which take no options.
std::vector<std::string> ProgramNames() {
  std::vector<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(SourceFolder() / "Examples")) {
    const std::string name = file.path().stem();
    const bool is_example = name == "minimal" || name == "objects_of_sequence";
    if (file.path().extension() == ".cc" && !is_example) {
      names.push_back(name);
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Programs, Help, ::testing::ValuesIn(ProgramNames()),
                         [](const auto& info) { return info.param; });

// Each --set takes one setting, so the help must not promise more.
TEST(HelpOfSettings, ShowsOneKeyAndValue) {
  for (const char* const program : {"rgbd_tum", "mono_video", "check_masks", "map_objects"}) {
    const std::string help = RunProgram(program, {"--help"}).output;
    const size_t at = help.find("--set KEY=VALUE");
    ASSERT_NE(at, std::string::npos) << help;
    EXPECT_NE(help.substr(at, 19), "--set KEY=VALUE ...");
  }
}

TEST(HelpOfSubcommands, NamesTheExitCodes) {
  for (const char* const command : {"trajectory", "objects"}) {
    const ProgramResult result = RunProgram("evaluate", {command, "--help"});
    EXPECT_NE(result.output.find("Exit codes: 0 "), std::string::npos) << result.output;
  }
}

}  // namespace
}  // namespace hullslam
