// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/run_sequence.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "support/expect_error.h"
#include "support/made_view.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

TEST(RunSequence, IsFoundInTheFoldersAboveTheRun) {
  const TemporaryFolder folder;
  folder.Write("project/data/desk/rgb.txt", "");
  folder.Write("project/results/run/summary.json", "{}");
  const auto run = folder.path() / "project/results/run";
  EXPECT_EQ(FindRunInput("data/desk", run), folder.path() / "project/data/desk");
  EXPECT_FALSE(FindRunInput("data/room", run));
  EXPECT_FALSE(FindRunInput("", run));
}

TEST(RunSequence, IsOpenedAsTheProgramReadIt) {
  const TemporaryFolder folder;
  folder.Write("tum/rgb.txt", "1.5 a.png\n2.5 b.png\n");
  const cv::Mat image(48, 64, CV_8UC3, cv::Scalar(1, 2, 3));
  for (const char* const name : {"a.png", "b.png"}) {
    cv::imwrite(folder.path() / "tum" / name, image);
  }
  const ImageSequence tum = OpenRunSequence({"rgbd_tum"}, folder.path() / "tum", MadeCamera());
  ASSERT_EQ(tum.frames.size(), 2u);
  EXPECT_EQ(tum.frames[1].timestamp, 2.5);
  const ImageSequence video = OpenRunSequence({"mono_video"}, folder.path() / "tum", MadeCamera());
  ASSERT_EQ(video.frames.size(), 2u);
  EXPECT_EQ(video.frames[0].timestamp, 0.0);
  ExpectInputError([&] { OpenRunSequence({"mono_euroc"}, folder.path() / "tum", MadeCamera()); },
                   {"tum"});
}

TEST(RunSequence, HasDepthImagesIfTheyAreAskedFor) {
  const TemporaryFolder folder;
  folder.Write("tum/rgb.txt", "1.5 a.png\n2.5 b.png\n");
  folder.Write("tum/depth.txt", "1.51 d.png\n");
  for (const char* const name : {"a.png", "b.png", "d.png"}) {
    folder.Write(std::string("tum/") + name, "");
  }
  const ImageSequence sequence =
      OpenRunSequence({"rgbd_tum"}, folder.path() / "tum", MadeCamera(), /*use_depth=*/true);
  ASSERT_EQ(sequence.frames.size(), 1U);
  EXPECT_EQ(sequence.frames[0].depth, folder.path() / "tum" / "d.png");
}

TEST(RunSequence, KnowsFromTheSummaryHowItWasOpened) {
  const RunOpening run = ReadRunOpening(nlohmann::json::parse(
      R"({"provenance": {"program": "mono_bag",
                         "sequence_choices": {"image_topic": "/left", "times": 3}}})"));
  EXPECT_EQ(run.program, "mono_bag");
  EXPECT_EQ(run.choices, (std::map<std::string, std::string>{{"image_topic", "/left"}}));
  for (const char* const text : {"[]", "{}", R"({"provenance": 1})",
                                 R"({"provenance": {"program": 1, "sequence_choices": [2]}})"}) {
    EXPECT_EQ(ReadRunOpening(nlohmann::json::parse(text)).program, "") << text;
  }
}

}  // namespace
}  // namespace hullslam
