// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/dataset_arguments.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "run/command_line.h"
#include "support/expect_error.h"

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

}  // namespace
}  // namespace hullslam
