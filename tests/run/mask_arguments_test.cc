// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/mask_arguments.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "files/read_file.h"
#include "hullslam/segmentation/segmenter.h"
#include "support/made_network.h"
#include "support/plane_sequence.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

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

}  // namespace
}  // namespace hullslam
