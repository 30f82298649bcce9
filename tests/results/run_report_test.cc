// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/run_report.h"

#include <gtest/gtest.h>

#include <string>

namespace hullslam {
namespace {

bool Tells(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(DescribeRun, NamesWhatTheImagesOfTheSensorLack) {
  RunSummary summary;
  summary.trajectory.frames = 3;
  summary.trajectory.tracked = 2;
  summary.trajectory.lost = 1;
  summary.trajectory.unpaired = 4;
  const auto told = [&](SensorKind sensor) { return DescribeRun(summary, {}, sensor, false); };
  EXPECT_TRUE(Tells(told(SensorKind::kRgbd),
                    "3 frames: 2 tracked, 1 lost, 0 skipped; 4 images without depth\n"));
  EXPECT_TRUE(Tells(told(SensorKind::kStereo), "4 images without a partner\n"));
  EXPECT_TRUE(Tells(told(SensorKind::kMonocular), "0 skipped\n0 keyframes, 0 landmarks\n"));
  summary.initialisation = InitialisationSummary();
  EXPECT_TRUE(Tells(told(SensorKind::kMonocular), "; no map\n"));
}

TEST(DescribeRun, TellsAboutPartsOfTheMapOnlyIfThereAreSome) {
  RunSummary summary;
  summary.islands = IslandsSummary{.begun = 1};
  EXPECT_FALSE(Tells(DescribeRun(summary, {}, SensorKind::kRgbd, false), "begun"));
  summary.islands = IslandsSummary{.begun = 3, .joined = 1};
  EXPECT_TRUE(Tells(DescribeRun(summary, {}, SensorKind::kRgbd, true),
                    "the map was begun 3 times; 1 of its parts were joined, 1 written on"));
}

TEST(FormatFigure, AnAbsentFigureIsADash) {
  EXPECT_EQ(FormatFigure(0.12345, 3), "0.123");
  EXPECT_EQ(FormatFigure(std::nullopt, 3), "-");
}

}  // namespace
}  // namespace hullslam
