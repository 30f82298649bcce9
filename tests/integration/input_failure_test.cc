// SPDX-License-Identifier: GPL-3.0-or-later
// Input that turns out to be bad in the middle of a run, for each kind of source: the results up to
// there are written.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "files/read_file.h"
#include "hullslam/results/trajectory_file.h"
#include "support/made_bags.h"
#include "support/made_network.h"
#include "support/made_room.h"
#include "support/plane_sequence.h"
#include "support/read_folder.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

using Arguments = std::vector<std::string>;
using Json = nlohmann::json;

constexpr int kFailureFrames = 10;
constexpr int kBad = 6;                 // the frame whose input is broken
constexpr double kRoomBaseline = 0.12;  // m

class InputFailure : public ::testing::Test {
 protected:
  ProgramResult Run(const std::string& program, Arguments arguments) const {
    arguments.insert(arguments.end(), {"--output", output_, "--quiet"});
    return RunProgram(program, arguments);
  }

  Json Summary() const { return Json::parse(ReadFile(output_ / "summary.json")); }

  // Expects exit code 2, the message with these parts, and the complete results of the frames
  // before the bad one. Without `has_poses`, they may be too few for a first map.
  void ExpectResultsUpToTheBadFrame(const ProgramResult& result,
                                    const std::vector<std::string>& parts,
                                    bool has_poses = true) const {
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    const size_t at = result.errors.find("error: ");
    ASSERT_NE(at, std::string::npos) << result.errors;
    const std::string error = result.errors.substr(at);
    for (const std::string& part : parts) {
      EXPECT_NE(error.find(part), std::string::npos) << part << " in " << error;
    }
    EXPECT_NE(error.find(fmt::format("after {} of {} frames", kBad, kFailureFrames)),
              std::string::npos)
        << error;
    ASSERT_TRUE(fs::exists(output_ / "summary.json")) << result.errors;
    const Json summary = Summary();
    EXPECT_EQ(summary["trajectory"]["frames"], kBad);
    EXPECT_EQ(summary["provenance"]["interrupted"], false);
    const std::string failure = summary["provenance"]["input_failure"];
    for (const std::string& part : parts) {
      EXPECT_NE(failure.find(part), std::string::npos) << part << " in " << failure;
    }
    if (has_poses) {
      EXPECT_EQ(ReadTrajectory(output_ / "trajectory.txt").size(), size_t{kBad});
    }
    EXPECT_EQ(ReadFolder(output_).size(), summary["files"].size() + 1);
  }

  // Expects that the bad frame ends a strict run, and that another run leaves it out.
  void ExpectFailureOf(const std::string& program, const Arguments& arguments,
                       const std::vector<std::string>& parts, bool has_poses = true) const {
    Arguments strict = arguments;
    strict.push_back("--strict");
    ExpectResultsUpToTheBadFrame(Run(program, strict), parts, has_poses);
    fs::remove_all(output_);
    Run(program, arguments);
    EXPECT_EQ(Summary()["trajectory"]["skipped"], 1) << program;
    EXPECT_EQ(Summary()["trajectory"]["frames"], kFailureFrames);
    EXPECT_TRUE(Summary()["provenance"]["input_failure"].is_null());
    fs::remove_all(output_);
  }

  // Cuts a file off, so that its image cannot be decoded.
  static void Break(const fs::path& file) { fs::resize_file(file, fs::file_size(file) / 2); }

  // Settings for the images of the room, with the baseline of its pairs.
  std::string WriteSettings() const {
    const PinholeCamera& camera = room_.camera();
    return folder_.Write(
        "camera.yaml",
        fmt::format("Camera.fx: {}\nCamera.fy: {}\nCamera.cx: {}\nCamera.cy: {}\nCamera.width: {}\n"
                    "Camera.height: {}\nCamera.fps: 10\nCamera.bf: {}\nDepthMapFactor: 5000\n",
                    camera.fx, camera.fy, camera.cx, camera.cy, camera.width, camera.height,
                    kRoomBaseline * camera.fx));
  }

  std::string WriteRoomPairs(const std::string& left, const std::string& right) const {
    room_.WritePairs(sequence_, left, right, kFailureFrames, kRoomBaseline);
    return sequence_;
  }

  TemporaryFolder folder_;
  std::string sequence_ = folder_.path() / "sequence";
  fs::path output_ = folder_.path() / "out";
  MadeRoom room_{2};
};

TEST_F(InputFailure, ImageAndDepthOfTum) {
  for (const char* const folder : {"rgb", "depth"}) {
    const PlaneSequence plane(kFailureFrames);
    const std::string bad = fmt::format("{}/{:02}.png", folder, kBad);
    Break(plane.path() / bad);
    ExpectFailureOf("rgbd_tum", {plane.path()}, {bad});
    ExpectFailureOf("rgbd_tum", {plane.path(), "--threaded"}, {bad});
    if (folder == std::string("rgb")) {
      ExpectFailureOf("mono_tum", {plane.path()}, {bad}, false);
    }
  }
}

TEST_F(InputFailure, ImageAndDepthOfIcl) {
  room_.WriteIclTum(sequence_, kFailureFrames, false);
  const std::string settings = WriteSettings();
  Break(sequence_ + fmt::format("/depth/{}.png", kBad));
  ExpectFailureOf("rgbd_icl", {sequence_, "--settings", settings, "--groundtruth-y", "down"},
                  {fmt::format("depth/{}.png", kBad)});
  Break(sequence_ + fmt::format("/rgb/{}.png", kBad));
  ExpectFailureOf("mono_icl", {sequence_, "--settings", settings, "--groundtruth-y", "down"},
                  {fmt::format("rgb/{}.png", kBad)}, false);
}

TEST_F(InputFailure, ImagesOfEuroc) {
  const std::string cam0 = "sequence/mav0/cam0";
  WriteRoomPairs("mav0/cam0/data", "mav0/cam1/data");
  const PinholeCamera& camera = room_.camera();
  for (int side = 0; side < 2; ++side) {
    const std::string folder = fmt::format("mav0/cam{}/", side);
    std::string list = "#timestamp [ns],filename\n";
    for (int i = 0; i < kFailureFrames; ++i) {
      list += fmt::format("{},{:06}.png\n", 1'000'000'000 + 100'000'000 * int64_t{i}, i);
    }
    folder_.Write("sequence/" + folder + "data.csv", list);
    folder_.Write(
        "sequence/" + folder + "sensor.yaml",
        fmt::format("T_BS:\n  data: [1.0, 0.0, 0.0, {}, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, "
                    "0.0, 0.0, 0.0, 1.0]\nrate_hz: 10\nresolution: [{}, {}]\ncamera_model: "
                    "pinhole\nintrinsics: [{}, {}, {}, {}]\ndistortion_model: radial-tangential\n"
                    "distortion_coefficients: [0.0, 0.0, 0.0, 0.0]\n",
                    side * kRoomBaseline, camera.width, camera.height, camera.fx, camera.fy,
                    camera.cx, camera.cy));
  }
  Break(sequence_ + fmt::format("/mav0/cam1/data/{:06}.png", kBad));
  ExpectFailureOf("stereo_euroc", {sequence_}, {fmt::format("cam1/data/{:06}.png", kBad)});
  Break(sequence_ + fmt::format("/mav0/cam0/data/{:06}.png", kBad));
  ExpectFailureOf("mono_euroc", {sequence_}, {fmt::format("cam0/data/{:06}.png", kBad)}, false);
}

TEST_F(InputFailure, PairsOfKittiAndOfFolders) {
  const std::string settings = WriteSettings();
  WriteRoomPairs("left", "right");
  Break(sequence_ + fmt::format("/right/{:06}.png", kBad));
  ExpectFailureOf("stereo_folder", {sequence_, "--settings", settings},
                  {fmt::format("right/{:06}.png", kBad)});
  sequence_ = folder_.path() / "kitti";
  WriteRoomPairs("image_0", "image_1");
  fs::remove(sequence_ + "/groundtruth.txt");
  const PinholeCamera& camera = room_.camera();
  std::string calibration;
  std::string times;
  for (int side = 0; side < 2; ++side) {
    calibration += fmt::format("P{}: {} 0 {} {} 0 {} {} 0 0 0 1 0\n", side, camera.fx, camera.cx,
                               side == 0 ? 0.0 : -kRoomBaseline * camera.fx, camera.fx, camera.cy);
  }
  for (int i = 0; i < kFailureFrames; ++i) {
    times += fmt::format("{}\n", 0.1 * i);
  }
  folder_.Write("kitti/calib.txt", calibration);
  folder_.Write("kitti/times.txt", times);
  Break(sequence_ + fmt::format("/image_0/{:06}.png", kBad));
  ExpectFailureOf("stereo_kitti", {sequence_}, {fmt::format("image_0/{:06}.png", kBad)});
}

TEST_F(InputFailure, FoldersOfImages) {
  const std::string settings = WriteSettings();
  WriteRoomPairs("left", "right");
  Break(sequence_ + fmt::format("/left/{:06}.png", kBad));
  ExpectFailureOf("mono_video", {sequence_ + "/left", "--settings", settings},
                  {fmt::format("{:06}.png", kBad)}, false);
}

// Messages of a recording: the images are compressed, and one of them is cut off.
std::vector<MadeMessage> Recording(const fs::path& sequence, const MadeRoom& room,
                                   MessageCoding coding, bool has_depth) {
  const PinholeCamera& camera = room.camera();
  std::vector<MadeMessage> messages;
  for (const std::string side : {"left", "right"}) {
    const uint64_t begin = 1'000'000'000;
    messages.push_back({"/" + side + "/camera_info", "sensor_msgs/CameraInfo", begin,
                        MadeCameraInfo(coding, static_cast<uint32_t>(camera.width),
                                       static_cast<uint32_t>(camera.height), "plumb_bob", {},
                                       camera.fx, side == "left" ? 0.0 : kRoomBaseline)});
    for (int i = 0; i < kFailureFrames; ++i) {
      const uint64_t time = begin + 100'000'000 * static_cast<uint64_t>(i);
      const bool is_depth = has_depth && side == "right";
      std::string bytes =
          ReadFile(sequence / (is_depth ? "depth" : side) /
                   (is_depth ? fmt::format("{}.png", i) : fmt::format("{:06}.png", i)));
      if (i == kBad && side == "right") {
        bytes.resize(bytes.size() / 2);
      }
      messages.push_back(
          {is_depth ? "/depth/image/compressed" : "/" + side + "/image/compressed",
           "sensor_msgs/CompressedImage", time,
           MadeCompressed(coding, time,
                          is_depth ? "16UC1; png compressed" : "mono8; png compressed", bytes)});
    }
  }
  return messages;
}

TEST_F(InputFailure, RecordingsOfAllFormats) {
  WriteRoomPairs("left", "right");
  room_.WriteIclTum(sequence_, kFailureFrames, false);
  const std::string settings = WriteSettings();
  const std::string stamp = fmt::format("{:.6f}", 1.0 + 0.1 * kBad);
  const auto pairs = [&](MessageCoding coding) {
    return Recording(sequence_, room_, coding, false);
  };
  const Arguments stereo = {"--settings",    settings,
                            "--image-topic", "/left/image/compressed",
                            "--right-topic", "/right/image/compressed"};
  const fs::path mcap = folder_.Write("a.mcap", MadeMcap(pairs(MessageCoding::kCdr), "zstd"));
  const fs::path ros1 = folder_.Write("a.bag", MadeRos1(pairs(MessageCoding::kRos1), "lz4"));
  const fs::path sqlite = WriteMadeSqlite(folder_.path() / "a.db3", pairs(MessageCoding::kCdr));
  for (const fs::path& bag : {mcap, ros1, sqlite}) {
    Arguments arguments = {bag};
    arguments.insert(arguments.end(), stereo.begin(), stereo.end());
    ExpectFailureOf("stereo_bag", arguments, {"right/image/compressed/" + stamp});
  }
  ExpectFailureOf("mono_bag",
                  {mcap, "--settings", settings, "--image-topic", "/right/image/compressed"},
                  {"right/image/compressed/" + stamp}, false);
  const fs::path depth = folder_.Write(
      "depth.mcap", MadeMcap(Recording(sequence_, room_, MessageCoding::kCdr, true), "zstd"));
  ExpectFailureOf("rgbd_bag", {depth, "--settings", settings}, {"depth/image/compressed/" + stamp});
}

TEST_F(InputFailure, DepthOfMappedObjects) {
  const PlaneSequence plane(kFailureFrames);
  for (int i = 0; i < kFailureFrames; ++i) {
    folder_.Write(fmt::format("masks/{:02}.txt", i),
                  "41 0.25 0.25 0.5 0.25 0.5 0.5 0.25 0.5 0.9\n");
  }
  const std::string bad = fmt::format("depth/{:02}.png", kBad);
  Break(plane.path() / bad);
  const Arguments arguments = {plane.path(),
                               "--poses",
                               plane.path() / "groundtruth.txt",
                               "--masks",
                               folder_.path() / "masks",
                               "--min-distance",
                               "0.005"};
  const ProgramResult result = Run("hullslam map-objects", arguments);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find(bad), std::string::npos) << result.errors;
  EXPECT_NE(result.errors.find(fmt::format("after {} of {} views", kBad, kFailureFrames)),
            std::string::npos)
      << result.errors;
  EXPECT_TRUE(fs::exists(output_ / "objects.json"));
  EXPECT_EQ(ReadTrajectory(output_ / "trajectory.txt").size(), size_t{kBad});
  EXPECT_NE(Summary()["provenance"]["input_failure"].get<std::string>().find(bad),
            std::string::npos);
}

TEST_F(InputFailure, ABadFirstImageLeavesNoResults) {
  const PlaneSequence plane(kFailureFrames);
  Break(plane.path() / "rgb/00.png");
  const ProgramResult result = Run("rgbd_tum", {plane.path(), "--strict"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("rgb/00.png"), std::string::npos) << result.errors;
  EXPECT_FALSE(fs::exists(output_));
}

// One bad image of a network is no failure of the run.
TEST_F(InputFailure, ANetworkThatFailsOnAnImage) {
  const PlaneSequence plane(kFailureFrames);
  const std::string name = fmt::format("rgb/{:02}.png", kBad);
  cv::Mat image = cv::imread(plane.path() / name);
  image(cv::Rect(0, 0, 100, 100)).setTo(cv::Scalar::all(255));
  cv::imwrite(plane.path() / name, image);
  const std::string network =
      folder_.Write("network.onnx", MadeNetwork{.overflows_on_white = true}.Bytes());
  for (const Arguments& more : {Arguments{}, Arguments{"--segment-every", "3"}}) {
    Arguments arguments = {plane.path(), "--segment", network};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = Run("rgbd_tum", arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.errors.find("warning: the network fails on 1 image, which has no masks"),
              std::string::npos)
        << result.errors;
    EXPECT_EQ(Summary()["trajectory"]["tracked"], kFailureFrames);
  }
}

}  // namespace
}  // namespace hullslam
