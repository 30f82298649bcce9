// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/dataset_arguments.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "files/read_file.h"
#include "hullslam/segmentation/segmenter.h"
#include "run/command_line.h"
#include "run/tools/commands.h"
#include "support/expect_error.h"
#include "support/made_network.h"
#include "support/plane_sequence.h"
#include "support/run_program.h"
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

namespace fs = std::filesystem;

// Runs rgbd_tum with a network on a plane with a red thing, which moves by 5 px per frame. The
// network sees the images a fifth as large, so a cell has 160 px, and the thing stays in one.
class SegmentOption : public testing::Test {
 protected:
  SegmentOption() : network_(folder_.Write("network.onnx", MadeNetwork().Bytes())) {
    for (int i = 0; i < kFrames; ++i) {
      const std::string file = (plane_.path() / "rgb" / fmt::format("{:02}.png", i)).string();
      cv::Mat image = cv::imread(file, cv::IMREAD_COLOR);
      PaintBlob({250 - 5 * i, 190, 60, 100}, true, image);
      cv::imwrite(file, image);
    }
  }

  std::string Output(const std::string& name) const { return (folder_.path() / name).string(); }

  ProgramResult Run(const std::string& output, std::vector<std::string> more) const {
    more.insert(more.begin(), {plane_.path().string(), "--quiet", "--output", Output(output)});
    return RunProgram("rgbd_tum", more);
  }

  nlohmann::json Summary(const std::string& output) const {
    return nlohmann::json::parse(ReadFile(Output(output) + "/summary.json"));
  }

  std::string Trajectory(const std::string& output) const {
    return ReadFile(Output(output) + "/trajectory.txt");
  }

  static constexpr int kFrames = 12;
  const PlaneSequence plane_{kFrames};
  const TemporaryFolder folder_;
  const std::filesystem::path network_;
};

TEST_F(SegmentOption, MakesTheMasksThatTheCommandSegmentWrites) {
  const ProgramResult result = Run("a", {"--segment", network_.string()});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  ASSERT_EQ(Run("b", {"--segment", network_.string()}).exit_code, 0);
  EXPECT_EQ(Trajectory("a"), Trajectory("b"));
  EXPECT_EQ(ReadFile(Output("a") + "/objects.json"), ReadFile(Output("b") + "/objects.json"));
  const ProgramResult made =
      RunProgram("hullslam", {"segment", plane_.path().string(), "--network", network_.string(),
                              "--output", Output("masks"), "--quiet"});
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  ASSERT_EQ(Run("c", {"--masks", Output("masks")}).exit_code, 0);
  EXPECT_EQ(Summary("a")["objects"]["detections"], kFrames);
  EXPECT_EQ(Trajectory("a"), Trajectory("c")) << "to the bit";
  EXPECT_EQ(ReadFile(Output("a") + "/objects.json"), ReadFile(Output("c") + "/objects.json"));
  EXPECT_EQ(Summary("a")["provenance"]["masks_format"], "network");
}

TEST_F(SegmentOption, TheSummaryNamesTheNetworkAndItsWork) {
  ASSERT_EQ(Run("a", {"--segment", network_.string(), "--segment-every", "3"}).exit_code, 0);
  const nlohmann::json network = Summary("a")["provenance"]["network"];
  EXPECT_EQ(network["path"], network_.string());
  EXPECT_EQ(network["hash"], Segmenter(network_).network_hash());
  EXPECT_EQ(network["every"], 3);
  EXPECT_EQ(network["classes"], (nlohmann::json{"red", "blue"}));
  EXPECT_GE(network["images"], kFrames / 3);
  EXPECT_EQ(network["failures"], 0);
  EXPECT_GT(Summary("a")["timing"]["stages_ms"]["segment"]["median"], 0.0);
  ASSERT_EQ(Run("b", {}).exit_code, 0);
  EXPECT_TRUE(Summary("b")["provenance"]["network"].is_null());
  EXPECT_FALSE(Summary("b")["timing"]["stages_ms"].contains("segment"));
}

TEST_F(SegmentOption, KeyframesGetMasksIfOnlyEveryNthFrameIsAskedFor) {
  const std::vector<std::string> arguments = {"--segment", network_.string(), "--segment-every",
                                              "100"};
  ASSERT_EQ(Run("a", arguments).exit_code, 0);
  ASSERT_EQ(Run("b", arguments).exit_code, 0);
  EXPECT_EQ(Trajectory("a"), Trajectory("b"));
  EXPECT_EQ(Summary("a")["objects"]["detections"], Summary("a")["map"]["keyframes"]);
}

TEST_F(SegmentOption, MasksComeLaterInRealTime) {
  const ProgramResult result = Run("a", {"--segment", network_.string(), "--realtime"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_GE(Summary("a")["objects"]["detections"], 1);
  EXPECT_TRUE(Summary("a")["provenance"]["network"]["every"].is_null());
}

TEST_F(SegmentOption, BadUseIsRefusedBeforeAnythingIsWritten) {
  const auto refused = [&](std::vector<std::string> arguments, const std::string& fault) {
    const ProgramResult result = Run("out", std::move(arguments));
    EXPECT_EQ(result.exit_code, 2) << fault;
    EXPECT_NE(result.errors.find(fault), std::string::npos) << result.errors;
    EXPECT_FALSE(std::filesystem::exists(Output("out")));
  };
  refused({"--segment", folder_.Write("text.onnx", "layers: 3\n").string()},
          "text.onnx: is a text");
  refused({"--segment", network_.string(), "--masks", Output("masks")}, "--masks");
  refused({"--segment-every", "3"}, "--segment");
}

// The right half of the images is ignored.
class MaskAllOption : public testing::Test {
 protected:
  MaskAllOption() {
    cv::Mat mask(480, 640, CV_8UC1, cv::Scalar(255));
    mask.colRange(320, 640).setTo(0);
    cv::imwrite(MaskPath("half.png"), mask);
    cv::imwrite(MaskPath("small.png"), mask(cv::Rect(0, 0, 640, 400)));
    cv::imwrite(MaskPath("exchanged.png"), mask(cv::Rect(0, 0, 640, 480)) * 0);
    mask.colRange(100, 640).setTo(0);
    cv::imwrite(MaskPath("little.png"), mask);
  }
  std::string MaskPath(const std::string& name) const { return (folder_.path() / name).string(); }
  ProgramResult Run(std::vector<std::string> more) const {
    more.insert(more.begin(), {plane_.path().string(), "--output", MaskPath("out")});
    return RunProgram("rgbd_tum", more);
  }
  nlohmann::json Provenance() const {
    return nlohmann::json::parse(ReadFile(MaskPath("out") + "/summary.json"))["provenance"];
  }

  const PlaneSequence plane_{4};
  const TemporaryFolder folder_;
};

TEST_F(MaskAllOption, IsWrittenIntoTheSummary) {
  const ProgramResult result = Run({"--mask-all", MaskPath("half.png")});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("50.0 % of the pixels are ignored"), std::string::npos)
      << result.output;
  EXPECT_EQ(Provenance()["mask_all"]["path"], MaskPath("half.png"));
  EXPECT_EQ(Provenance()["mask_all"]["ignored"], 0.5);
  EXPECT_TRUE(Provenance()["mask_all_right"].is_null());
  ASSERT_EQ(Run({}).exit_code, 0);
  EXPECT_TRUE(Provenance()["mask_all"].is_null());
}

TEST_F(MaskAllOption, OfMostOfTheImageIsAWarning) {
  const ProgramResult result = Run({"--quiet", "--mask-all", MaskPath("little.png")});
  EXPECT_NE(result.errors.find("are black and white exchanged?"), std::string::npos)
      << result.errors;
}

TEST_F(MaskAllOption, IsRefusedBeforeAnythingIsWritten) {
  const auto refused = [&](const std::string& file, const std::string& fault) {
    const ProgramResult result = Run({"--mask-all", MaskPath(file)});
    EXPECT_EQ(result.exit_code, 2) << fault;
    EXPECT_NE(result.errors.find(fault), std::string::npos) << result.errors;
    EXPECT_FALSE(std::filesystem::exists(MaskPath("out")));
  };
  refused("small.png", "640x400");
  refused("exchanged.png", "black everywhere");
  refused("none.png", "none.png");
  EXPECT_EQ(Run({"--mask-all-right", MaskPath("half.png")}).exit_code, 2)
      << "there is no right one";
}

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
