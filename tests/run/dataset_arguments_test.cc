// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/dataset_arguments.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "run/command_line.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

AnyDatasetArguments Parse(std::vector<std::string> words) {
  CLI::App app("test", "test");
  AnyDatasetArguments arguments;
  AddAnyDatasetOptions(app, arguments);
  words.insert(words.begin(), "test");
  std::vector<char*> pointers;
  for (std::string& word : words) {
    pointers.push_back(word.data());
  }
  ParseCommandLine(app, static_cast<int>(pointers.size()), pointers.data());
  return arguments;
}

TEST(DatasetArguments, OptionsBecomeChoices) {
  const AnyDatasetArguments arguments =
      Parse({"--stereo", "--image-topic", "/left", "--recording-times"});
  EXPECT_EQ(arguments.sensor, SensorKind::kStereo);
  EXPECT_EQ(arguments.choices, (DatasetChoices{{"image_topic", "/left"}, {"times", "recording"}}));
  EXPECT_TRUE(Parse({}).choices.empty());
  ExpectInputError([] { Parse({"--fov", "wide"}); }, {"--fov", "'wide'", "a number"});
}

TEST(DatasetArguments, AChoiceThatTheDataSetDoesNotHaveIsRefused) {
  const TemporaryFolder folder;
  folder.Write("tum/rgb.txt", "");
  ExpectInputError(
      [&] {
        FindGivenDataset(folder.path() / "tum", Parse({"--fov", "60"}));
      },
      {"--fov is given", "TUM RGB-D", "no such choice"});
  folder.Write("walk.mp4", "");
  EXPECT_EQ(ProgramOf(*FindGivenDataset(folder.path() / "walk.mp4", Parse({"--fov", "60"})).dataset,
                      SensorKind::kMonocular),
            "mono_video");
  EXPECT_EQ(FindGivenDataset(folder.path() / "walk.mp4", Parse({"--side-by-side"})).sensor,
            SensorKind::kStereo);
}

}  // namespace
}  // namespace hullslam
