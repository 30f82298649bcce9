// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/vslamlab_sequence.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

const std::string kCalibration =
    "%YAML 1.2\n"
    "---\n"
    "cameras:\n"
    "- {cam_name: rgb_0,\n"
    "   cam_type: rgb+depth,\n"
    "   depth_name: depth_0,\n"
    "   depth_factor: 5000.0,\n"
    "   cam_model: radtan5,\n"
    "   focal_length: [517.3, 516.5],\n"
    "   principal_point: [318.6, 255.3],\n"
    "   distortion_coefficients: [0.26, -0.95, -0.005, 0.002, 1.16],\n"
    "   image_dimension: [640, 480],\n"
    "   fps: 30.0,\n"
    "   T_BS: [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]\n"
    "  }\n"
    "- {cam_name: rgb_1,\n"
    "   cam_model: pinhole,\n"
    "   focal_length: [481.2, -480],\n"
    "   principal_point: [319.5, 239.5],\n"
    "   image_dimension: [640, 480],\n"
    "   fps: 30\n"
    "  }\n";
const std::string kList =
    "ts_rgb_0 (ns),path_rgb_0,ts_depth_0 (ns),path_depth_0\n"
    "1305031102175304031,rgb_0/a 1.png,1305031102160407066,depth_0/a.png\n"
    "1305031102211214065,rgb_0/b.png,1305031102194330066,depth_0/b.png\n";

std::string ReplaceIn(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

class VslamlabSequenceTest : public ::testing::Test {
 protected:
  VslamlabSequenceTest() {
    for (const char* const name :
         {"rgb_0/a 1.png", "rgb_0/b.png", "depth_0/a.png", "depth_0/b.png"}) {
      folder_.Write(name, "");
    }
  }
  VslamlabCamera ReadCamera(const std::string& text, const std::string& name = "rgb_0") const {
    return ReadVslamlabCamera(folder_.Write("calibration.yaml", text), name);
  }
  void ExpectBadCamera(const std::string& text, std::vector<std::string> parts) const {
    parts.emplace_back("calibration.yaml");
    ExpectInputError([&] { ReadCamera(text); }, parts);
  }
  VslamlabSequence Open(const std::string& list, const std::string& depth = "depth_0") const {
    return OpenVslamlabSequence(folder_.path(), folder_.Write("rgb.csv", list), "rgb_0", depth);
  }
  void ExpectBadList(const std::string& list, std::vector<std::string> parts) const {
    parts.emplace_back("rgb.csv");
    ExpectInputError([&] { Open(list); }, parts);
  }

  TemporaryFolder folder_;
};

TEST_F(VslamlabSequenceTest, ReadsTheCamera) {
  const VslamlabCamera camera = ReadCamera(kCalibration);
  EXPECT_EQ(camera.calibration.camera.fx, 517.3);
  EXPECT_EQ(camera.calibration.camera.cy, 255.3);
  EXPECT_EQ(camera.calibration.camera.k3, 1.16);
  EXPECT_EQ(camera.calibration.camera.p1, -0.005);
  EXPECT_EQ(camera.calibration.frames_per_second, 30.0);
  EXPECT_EQ(camera.depth_name, "depth_0");
  EXPECT_EQ(camera.depth_factor, 5000.0);
  EXPECT_FALSE(camera.is_mirrored);
}

TEST_F(VslamlabSequenceTest, ANegativeFocalLengthIsThatOfAMirroredWorld) {
  const VslamlabCamera camera = ReadCamera(kCalibration, "rgb_1");
  EXPECT_EQ(camera.calibration.camera.fy, 480.0);
  EXPECT_TRUE(camera.is_mirrored);
  EXPECT_FALSE(camera.calibration.camera.IsDistorted());
  EXPECT_TRUE(camera.depth_name.empty());
}

TEST_F(VslamlabSequenceTest, RefusesACalibrationThatItCannotUse) {
  ExpectBadCamera("", {"cameras"});
  ExpectBadCamera("cameras: [", {"calibration.yaml"});
  ExpectBadCamera(ReplaceIn(kCalibration, "cam_name: rgb_0", "cam_name: left"),
                  {"no camera 'rgb_0'", "left, rgb_1"});
  ExpectBadCamera(ReplaceIn(kCalibration, "radtan5", "equid4"), {"'equid4'", "radtan"});
  ExpectBadCamera(ReplaceIn(kCalibration, "[517.3, 516.5]", "[517.3]"),
                  {"focal_length", "1 value"});
  ExpectBadCamera(ReplaceIn(kCalibration, "[517.3, 516.5]", "[.nan, 516.5]"), {"focal_length"});
  ExpectBadCamera(ReplaceIn(kCalibration, "[640, 480]", "[640.5, 480]"), {"image_dimension"});
  ExpectBadCamera(ReplaceIn(kCalibration, "fps: 30.0,", ""), {"fps"});
  ExpectBadCamera(ReplaceIn(kCalibration, ", 1.16]", "]"), {"distortion_coefficients"});
  ExpectBadCamera(ReplaceIn(kCalibration, "depth_factor: 5000.0,", ""), {"depth_factor"});
}

TEST_F(VslamlabSequenceTest, ReadsTheListAndKeepsExactStamps) {
  const VslamlabSequence sequence = Open(kList);
  ASSERT_EQ(sequence.images.frames.size(), 2U);
  EXPECT_EQ(sequence.stamps[0], 1305031102175304031);
  EXPECT_NEAR(sequence.images.frames[0].timestamp, 1305031102.175304, 1e-6);
  EXPECT_EQ(sequence.images.frames[0].image, folder_.path() / "rgb_0/a 1.png");
  EXPECT_EQ(sequence.images.frames[1].depth, folder_.path() / "depth_0/b.png");
  EXPECT_TRUE(Open(kList, "").images.frames[0].depth.empty());
}

TEST_F(VslamlabSequenceTest, RefusesBrokenLists) {
  ExpectBadList("", {"no images"});
  ExpectBadList("ts_rgb_1 (ns),path_rgb_1\n", {"rgb.csv:1", "ts_rgb_0 (ns)", "ts_rgb_1 (ns)"});
  ExpectBadList(ReplaceIn(kList, ",depth_0/b.png", ""), {"rgb.csv:3", "3 column(s)"});
  ExpectBadList(ReplaceIn(kList, "1305031102211214065", "1.3e9"), {"rgb.csv:3", "1.3e9"});
  ExpectBadList(ReplaceIn(kList, "1305031102211214065", "1305031102165304031"),
                {"rgb.csv:3", "does not come after"});
  ExpectInputError([&] { Open(ReplaceIn(kList, "rgb_0/b.png", "rgb_0/none.png")); }, {"none.png"});
}

// Two cameras 0.1 m apart; `right` is the pose of the right one on the body.
std::string Pair(const std::string& right) {
  const std::string camera =
      "cam_model: pinhole, focal_length: [400, 400], principal_point: [319.5, 239.5], "
      "image_dimension: [640, 480], fps: 20, ";
  return "cameras:\n- {cam_name: l, " + camera +
         "T_SC: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}\n- {cam_name: r, " + camera +
         right + "}\n";
}

TEST_F(VslamlabSequenceTest, ReadsPairs) {
  const std::string right = "T_BS: [1, 0, 0, 0.1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]";
  const VslamlabPair pair = ReadVslamlabPair(folder_.Write("c.yaml", Pair(right)), {"l", "r"});
  EXPECT_NEAR(pair.calibration.camera.bf, 40.0, 1e-9);
  EXPECT_EQ(pair.calibration.frames_per_second, 20.0);
  const auto list = folder_.Write(
      "rgb.csv",
      "ts_l (ns),path_l,ts_r (ns),path_r\n1000000000,rgb_0/b.png,1000000000,depth_0/b.png\n");
  const VslamlabSequence sequence = OpenVslamlabPairs(folder_.path(), list, {"l", "r"}, pair);
  ASSERT_EQ(sequence.images.frames.size(), 1u);
  EXPECT_EQ(sequence.images.frames[0].right, folder_.path() / "depth_0/b.png");
  EXPECT_TRUE(sequence.images.frames[0].depth.empty());
  EXPECT_EQ(sequence.images.choices.at("right_name"), "r");
}

TEST_F(VslamlabSequenceTest, RefusesCamerasThatAreNoPair) {
  const auto expect = [&](const std::string& right, const std::vector<std::string>& parts) {
    ExpectInputError(
        [&] {
          ReadVslamlabPair(folder_.Write("c.yaml", Pair(right)), {"l", "r"});
        },
        parts);
  };
  expect("T_BS: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]", {"l and r", "baseline is 0 m"});
  expect("T_BS: [1, 0, 0, -0.1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]", {"swapped"});
  expect("T_BS: [2, 0, 0, 0.1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]",
         {"T_BS is not a rigid transform"});
  expect("T_BS: [1, 0]", {"T_BS"});
  expect("cam_type: grey", {"T_BS is not given"});
}

}  // namespace
}  // namespace hullslam
