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

// The commands of hullslam and the links that stand for them.
constexpr std::array<std::pair<const char*, const char*>, 9> kLinkedTools = {
    {{"check-masks", "check_masks"},
     {"convert-vocabulary", "convert_vocabulary"},
     {"evaluate", "evaluate"},
     {"export", "export"},
     {"map-objects", "map_objects"},
     {"query", "query_objects"},
     {"relocalise", "relocalise"},
     {"train-vocabulary", "train_vocabulary"},
     {"view", "view"}}};

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

// All programs, and the names of former programs, which are links to hullslam now. The others of
// the folder are examples of the library, which take no options.
std::vector<std::string> ProgramNames() {
  std::vector<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(SourceFolder() / "Examples")) {
    const std::string name = file.path().stem();
    const bool is_example = name == "minimal" || name == "objects_of_sequence";
    if (file.path().extension() == ".cc" && !is_example) {
      names.push_back(name);
    }
  }
  for (const auto& [command, link] : kLinkedTools) {
    names.emplace_back(link);
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

// ---- the program hullslam

// The text without the name by which the program was called.
std::string WithoutName(std::string text, const std::string& called) {
  const std::string usage = "Usage: " + called + " ";
  const size_t at = text.find(usage);
  EXPECT_NE(at, std::string::npos) << usage << " is not in " << text;
  return at == std::string::npos ? text : text.replace(at, usage.size(), "Usage: ");
}

TEST(HullslamProgram, ACommandAndItsLinkAreTheSameProgram) {
  for (const auto& [command, link] : kLinkedTools) {
    const ProgramResult by_link = RunProgram(link, {"--help"});
    const ProgramResult by_name = RunProgram("hullslam", {command, "--help"});
    EXPECT_EQ(by_name.exit_code, 0) << command;
    EXPECT_EQ(WithoutName(by_link.output, link),
              WithoutName(by_name.output, std::string("hullslam ") + command));
  }
}

TEST(HullslamProgram, ACommandAndItsLinkFailAlike) {
  for (const auto& [command, link] : {kLinkedTools.front(), kLinkedTools.back()}) {
    const ProgramResult by_link = RunProgram(link, {"--no-such-option"});
    const ProgramResult by_name = RunProgram("hullslam", {command, "--no-such-option"});
    EXPECT_EQ(by_link.exit_code, 2) << link;
    EXPECT_EQ(by_name.exit_code, 2) << command;
    EXPECT_EQ(by_link.errors, by_name.errors);
  }
}

// The renderer is a file of its own, so that its libraries are loaded only when it runs.
TEST(HullslamProgram, StartsTheProgramOfMakeSynthetic) {
  const ProgramResult itself = RunProgram("make_synthetic", {"--help"});
  const ProgramResult started = RunProgram("hullslam", {"make-synthetic", "--help"});
  EXPECT_EQ(WithoutName(itself.output, "make_synthetic"),
            WithoutName(started.output, "hullslam make-synthetic"));
  EXPECT_EQ(RunProgram("hullslam", {"make-synthetic"}).exit_code, 2);
}

TEST(HullslamProgram, IsRecognisedByTheNameOfALinkAnywhere) {
  const TemporaryFolder folder;
  for (const char* const link : {"check_masks", "view"}) {
    const std::string installed = std::string("hullslam-") + link;
    std::filesystem::create_symlink(ProgramPath("hullslam"), folder.path() / installed);
    EXPECT_EQ(RunShell((folder.path() / installed).string() +
                       " --help | grep -q '^Usage: " + installed + " '"),
              0);
  }
}

TEST(HullslamProgram, WithoutACommandPrintsTheHelpAndRefuses) {
  const ProgramResult result = RunProgram("hullslam", {});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.output, RunProgram("hullslam", {"--help"}).output);
  for (const auto& [command, link] : kLinkedTools) {
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
