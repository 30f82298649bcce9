// SPDX-License-Identifier: GPL-3.0-or-later
#include "datasets/run_sequence.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "support/comma_locale.h"
#include "support/expect_error.h"
#include "support/made_view.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

TEST(RunSequence, IsOpenedAsTheRunReadIt) {
  const TemporaryFolder folder;
  folder.Write("tum/rgb.txt", "1.5 a.png\n2.5 b.png\n");
  const cv::Mat image(48, 64, CV_8UC3, cv::Scalar(1, 2, 3));
  for (const char* const name : {"a.png", "b.png"}) {
    cv::imwrite(folder.path() / "tum" / name, image);
  }
  const ImageSequence tum =
      OpenRunSequence({.path = {}, .dataset = "tum"}, folder.path() / "tum", MadeCamera());
  ASSERT_EQ(tum.frames.size(), 2u);
  EXPECT_EQ(tum.frames[1].timestamp, 2.5);
  const ImageSequence video =
      OpenRunSequence({.path = {}, .dataset = "video"}, folder.path() / "tum", MadeCamera());
  ASSERT_EQ(video.frames.size(), 2u);
  EXPECT_EQ(video.frames[0].timestamp, 0.0);
  ExpectInputError(
      [&] {
        OpenRunSequence({.path = {}, .dataset = "euroc"}, folder.path() / "tum", MadeCamera());
      },
      {"tum"});
}

TEST(RunSequence, ARunWithoutADataSetHasTheOneOfItsProgram) {
  const TemporaryFolder folder;
  folder.Write("rgb.txt", "1.5 a.png\n");
  cv::imwrite(folder.path() / "a.png", cv::Mat(48, 64, CV_8UC1, cv::Scalar(9)));
  const auto open = [&](const char* program) {
    return OpenRunSequence({.path = {}, .dataset = {}, .program = program}, folder.path(),
                           MadeCamera());
  };
  EXPECT_EQ(open("rgbd_tum").dataset, "tum");
  EXPECT_EQ(open("map_objects").dataset, "tum");
  EXPECT_EQ(open("mono_video").dataset, "video");
  ExpectInputError([&] { open("vslamlab_hullslam_mono"); }, {"does not say of which data set"});
}

TEST(RunSequence, PairsAreOpenedWithTheRateOfTheRun) {
  const TemporaryFolder folder;
  for (const char* const name : {"left/0.png", "right/0.png", "left/1.png", "right/1.png"}) {
    folder.Write(name, "");
  }
  const ImageSequence sequence = OpenRunSequence(
      {.path = {}, .dataset = "stereo_folder", .choices = {{"frames_per_second", "4"}}},
      folder.path(), MadeCamera());
  ASSERT_EQ(sequence.frames.size(), 2u);
  EXPECT_EQ(sequence.frames[1].timestamp - sequence.frames[0].timestamp, 0.25);
  EXPECT_EQ(sequence.frames[1].right.filename(), "1.png");
}

TEST(RunSequence, ADecimalCommaOfTheProgramDoesNotMatter) {
  const CommaLocale comma;
  const TemporaryFolder folder;
  for (const char* const name : {"left/0.png", "right/0.png", "left/1.png", "right/1.png"}) {
    folder.Write(name, "");
  }
  const ImageSequence sequence = OpenRunSequence(
      {.path = {}, .dataset = "stereo_folder", .choices = {{"frames_per_second", "2.5"}}},
      folder.path(), MadeCamera());
  EXPECT_EQ(sequence.frames[1].timestamp - sequence.frames[0].timestamp, 0.4);
}

TEST(RunSequence, AChoiceThatIsNoNumberIsNamed) {
  const TemporaryFolder folder;
  ExpectInputError(
      [&] {
        OpenRunSequence(
            {.path = {}, .dataset = "stereo_folder", .choices = {{"frames_per_second", "2,5"}}},
            folder.path(), MadeCamera());
      },
      {"frames_per_second in summary.json is '2,5', expected a number"});
}

TEST(RunSequence, HasDepthImagesIfTheyAreAskedFor) {
  const TemporaryFolder folder;
  folder.Write("tum/rgb.txt", "1.5 a.png\n2.5 b.png\n");
  folder.Write("tum/depth.txt", "1.51 d.png\n");
  for (const char* const name : {"a.png", "b.png", "d.png"}) {
    folder.Write(std::string("tum/") + name, "");
  }
  const ImageSequence sequence = OpenRunSequence(
      {.path = {}, .dataset = "tum"}, folder.path() / "tum", MadeCamera(), /*use_depth=*/true);
  ASSERT_EQ(sequence.frames.size(), 1U);
  EXPECT_EQ(sequence.frames[0].depth, folder.path() / "tum" / "d.png");
}

TEST(RunSequence, AFolderOfImagesHasTheStampsOfTheRun) {
  const TemporaryFolder folder;
  for (const char* const name : {"0.png", "1.png"}) {
    cv::imwrite((folder.path() / name).string(), cv::Mat(48, 64, CV_8UC1, cv::Scalar(9)));
  }
  const ImageSequence sequence =
      OpenRunSequence({.path = {},
                       .dataset = "video",
                       .choices = {{"frames_per_second", "4"}, {"stamp_offset", "100.5"}}},
                      folder.path(), MadeCamera());
  ASSERT_EQ(sequence.frames.size(), 2U);
  EXPECT_EQ(sequence.frames[1].timestamp, 100.75);
}

TEST(RunSequence, OfAnUnknownDataSetIsRefused) {
  const TemporaryFolder folder;
  ExpectInputError([&] { OpenRunSequence({}, folder.path() / "gone", MadeCamera()); },
                   {"gone", "does not say of which data set", "repeat the run"});
  ExpectInputError(
      [&] { OpenRunSequence({.path = {}, .dataset = "kinect"}, folder.path(), MadeCamera()); },
      {"'kinect'", "bag, bag_stereo, euroc, ", "tum"});
}

}  // namespace
}  // namespace hullslam
