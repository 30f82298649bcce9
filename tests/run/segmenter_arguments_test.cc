// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/segmenter_arguments.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>

#include "run/tools/commands.h"
#include "support/expect_error.h"
#include "support/made_network.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

std::string ReadText(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// The command `segment` on a folder of four images, of which the third shows nothing.
class SegmentCommand : public testing::Test {
 protected:
  SegmentCommand() {
    for (int i = 0; i < 4; ++i) {
      cv::Mat image = GreyImage(128, 96);
      if (i != 2) {
        PaintBlob({4 + 32 * (i % 3), 4, 24, 24}, i % 2 == 0, image);
      }
      fs::create_directories(folder_.path() / "images");
      cv::imwrite((folder_.path() / "images" / ("img" + std::to_string(i) + ".png")).string(),
                  image);
    }
    network_ = folder_.Write("network.onnx", MadeNetwork().Bytes());
  }

  int Run(const std::vector<std::string>& more = {}, const std::string& output = "masks",
          const std::string& input = "images") {
    std::vector<std::string> words = {
        "segment",  (folder_.path() / input).string(),  "--network", network_.string(),
        "--output", (folder_.path() / output).string(), "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    std::vector<char*> pointers;
    for (std::string& word : words) {
      pointers.push_back(word.data());
    }
    return RunSegment(static_cast<int>(pointers.size()), pointers.data());
  }

  fs::path Mask(const std::string& name, const std::string& output = "masks") const {
    return folder_.path() / output / name;
  }

  TemporaryFolder folder_;
  fs::path network_;
};

TEST_F(SegmentCommand, WritesAFileForEachImageAndTheNamesOfTheClasses) {
  EXPECT_EQ(Run(), 0);
  EXPECT_EQ(ReadText(Mask("classes.txt")), "red\nblue\n");
  EXPECT_TRUE(ReadText(Mask("img0.txt")).starts_with("0 "));
  EXPECT_TRUE(ReadText(Mask("img1.txt")).starts_with("1 "));
  EXPECT_TRUE(fs::exists(Mask("img2.txt")));
  EXPECT_EQ(ReadText(Mask("img2.txt")), "");
}

TEST_F(SegmentCommand, GoesOnWhereItWasStopped) {
  EXPECT_EQ(Run(), 0);
  const std::string made = ReadText(Mask("img1.txt"));
  fs::remove(Mask("img1.txt"));
  fs::remove(Mask("classes.txt"));  // as if the first call was killed early
  folder_.Write("masks/img0.txt", "0 0.1 0.1 0.2 0.1 0.2 0.2 0.9\n");  // stays
  EXPECT_EQ(Run(), 0);
  EXPECT_EQ(ReadText(Mask("img1.txt")), made);
  EXPECT_EQ(ReadText(Mask("classes.txt")), "red\nblue\n");
  EXPECT_EQ(ReadText(Mask("img0.txt")), "0 0.1 0.1 0.2 0.1 0.2 0.2 0.9\n");
}

TEST_F(SegmentCommand, DoesNotMixMasksOfSeveralKinds) {
  EXPECT_EQ(Run(), 0);
  ExpectInputError([&] { Run({"--min-score", "0.5"}); }, {"masks", "0.25", "0.5", "--output"});
  fs::copy(folder_.path() / "images", folder_.path() / "walk");
  ExpectInputError([&] { Run({}, "masks", "walk"); }, {"masks", "images", "walk"});
  folder_.Write("other/notes.txt", "mine");
  ExpectInputError([&] { Run({}, "other"); }, {"other", "contains files"});
  EXPECT_EQ(ReadText(folder_.path() / "other" / "notes.txt"), "mine");
}

TEST_F(SegmentCommand, TakesEveryNthFrameAndTheClassesThatAreAskedFor) {
  EXPECT_EQ(Run({"--every", "3", "--classes", "blue"}), 0);
  EXPECT_EQ(ReadText(Mask("img0.txt")), "");  // red
  EXPECT_FALSE(fs::exists(Mask("img1.txt")));
  EXPECT_TRUE(ReadText(Mask("img3.txt")).starts_with("1 "));
}

TEST_F(SegmentCommand, SkipsAnImageThatCannotBeReadAndSaysIfNothingIsFound) {
  folder_.Write("images/img1.png", "no image");
  testing::internal::CaptureStderr();
  EXPECT_EQ(Run({"--min-score", "1"}), 0);
  const std::string errors = testing::internal::GetCapturedStderr();
  EXPECT_NE(errors.find("img1.png"), std::string::npos) << errors;
  EXPECT_NE(errors.find("found nothing in 3 images"), std::string::npos) << errors;
  EXPECT_FALSE(fs::exists(Mask("img1.txt")));
  folder_.Write("sequence/rgb/1.000000.png", "no image");
  folder_.Write("sequence/rgb/1.100000.png", "no image");
  testing::internal::CaptureStderr();
  EXPECT_EQ(Run({}, "none", "sequence"), 2);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("none of its images"), std::string::npos);
}

TEST_F(SegmentCommand, AnImageThatTheNetworkFailsOnDoesNotStopTheOthers) {
  folder_.Write("network.onnx", MadeNetwork{.overflows_on_white = true}.Bytes());
  const cv::Mat white(96, 128, CV_8UC3, cv::Scalar::all(255));
  cv::imwrite((folder_.path() / "images/img1.png").string(), white);
  for (int call = 0; call < 2; ++call) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(Run(), 0);
    const std::string errors = testing::internal::GetCapturedStderr();
    EXPECT_NE(errors.find("warning: the network fails on 1 image, which has no masks; the first is "
                          "img1.png: "),
              std::string::npos)
        << errors;
    EXPECT_TRUE(fs::exists(Mask("img0.txt")));
    EXPECT_FALSE(fs::exists(Mask("img1.txt"))) << "an empty file would say that nothing is there";
    EXPECT_TRUE(fs::exists(Mask("img3.txt")));
  }
  for (const char* const name : {"img0.png", "img2.png", "img3.png"}) {
    cv::imwrite((folder_.path() / "images" / name).string(), white);
  }
  EXPECT_EQ(Run({}, "none"), 2);
}

// Its masks would take the place of the names of the classes.
TEST_F(SegmentCommand, AnImageCalledClassesIsLeftOut) {
  cv::imwrite((folder_.path() / "images/classes.png").string(), GreyImage(128, 96));
  for (int call = 0; call < 2; ++call) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(Run(), 0);
    const std::string errors = testing::internal::GetCapturedStderr();
    EXPECT_NE(errors.find("classes.png: its masks would be in"), std::string::npos) << errors;
    EXPECT_EQ(ReadText(Mask("classes.txt")), "red\nblue\n");
    EXPECT_TRUE(fs::exists(Mask("img3.txt")));
  }
}

}  // namespace
}  // namespace hullslam
