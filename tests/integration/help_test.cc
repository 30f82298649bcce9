// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "support/run_program.h"

namespace hullslam {
namespace {

constexpr std::array<const char*, 11> kCommands = {
    "check-masks", "convert-vocabulary", "evaluate", "export",           "map-objects", "mesh",
    "query",       "relocalise",         "segment",  "train-vocabulary", "view"};

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

// All programs and commands.
std::vector<std::string> ProgramNames() {
  std::vector<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(SourceFolder() / "Examples")) {
    const std::string name = file.path().stem();
    if (file.path().extension() == ".cc") {
      names.push_back(name);
    }
  }
  for (const char* const command : kCommands) {
    names.push_back(std::string("hullslam ") + command);
  }
  std::sort(names.begin(), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Programs, Help, ::testing::ValuesIn(ProgramNames()), [](const auto& info) {
  std::string name = info.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
  return name;
});

// Each --set takes one setting, so the help must not promise more.
TEST(HelpOfSettings, ShowsOneKeyAndValue) {
  for (const char* const program :
       {"rgbd_tum", "mono_video", "hullslam check-masks", "hullslam map-objects"}) {
    const std::string help = RunProgram(program, {"--help"}).output;
    const size_t at = help.find("--set KEY=VALUE");
    ASSERT_NE(at, std::string::npos) << help;
    EXPECT_NE(help.substr(at, 19), "--set KEY=VALUE ...");
  }
}

TEST(HelpOfSubcommands, NamesTheExitCodes) {
  for (const char* const command : {"trajectory", "objects"}) {
    const ProgramResult result = RunProgram("hullslam evaluate", {command, "--help"});
    EXPECT_NE(result.output.find("Exit codes: 0 "), std::string::npos) << result.output;
  }
}

// ---- the program hullslam

// The text without the name by which the program was called.
std::string WithoutName(std::string text, const std::string& called) {
  const std::string usage = "Usage: " + called + " ";
  const size_t at = text.find(usage);
  EXPECT_NE(at, std::string::npos) << usage << " is not in " << text;
  return at == std::string::npos ? text : text.replace(at, usage.size(), "Usage: ");
}

// The renderer is a file of its own, so that its libraries are loaded only when it runs.
TEST(HullslamProgram, StartsTheProgramOfMakeSynthetic) {
  const ProgramResult itself = RunProgram("make_synthetic", {"--help"});
  const ProgramResult started = RunProgram("hullslam", {"make-synthetic", "--help"});
  EXPECT_EQ(WithoutName(itself.output, "make_synthetic"),
            WithoutName(started.output, "hullslam make-synthetic"));
  EXPECT_EQ(RunProgram("hullslam", {"make-synthetic"}).exit_code, 2);
}

// Each tool has one name. Names like `export` and `view` belong to the shell and to other programs.
TEST(HullslamProgram, CommandsAreNoProgramsOfTheirOwn) {
  for (const char* const former : {"check_masks", "export", "query_objects", "view"}) {
    EXPECT_FALSE(std::filesystem::exists(ProgramPath(former))) << former;
  }
}

TEST(HullslamProgram, WithoutACommandPrintsTheHelpAndRefuses) {
  const ProgramResult result = RunProgram("hullslam", {});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.output, RunProgram("hullslam", {"--help"}).output);
  for (const char* const command : kCommands) {
    EXPECT_NE(result.output.find(std::string("  ") + command + " "), std::string::npos) << command;
  }
}

TEST(HullslamProgram, AWrongCommandIsRefusedWithASuggestion) {
  const std::array<std::pair<const char*, const char*>, 6> suggestions = {
      {{"evalute", "did you mean evaluate?"},
       {"check_masks", "did you mean check-masks?"},
       {"query_objects", "did you mean query?"},
       {"map", "did you mean map-objects?"},
       {"--hepl", "'--hepl' is no command ("},
       {"", "'' is no command ("}}};
  for (const auto& [word, suggestion] : suggestions) {
    const ProgramResult result = RunProgram("hullslam", {word, "--help"});
    EXPECT_EQ(result.exit_code, 2) << word;
    EXPECT_EQ(result.output, "") << word;
    EXPECT_TRUE(result.errors.starts_with("error: ")) << result.errors;
    EXPECT_NE(result.errors.find(suggestion), std::string::npos) << result.errors;
  }
}

}  // namespace
}  // namespace hullslam
