// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <regex>
#include <string>
#include <vector>

#include "files/read_file.h"
#include "sequences/named_images.h"
#include "support/made_bags.h"
#include "support/made_room.h"
#include "support/mono_program.h"
#include "support/test_data.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 12;
constexpr double kBaseline = 0.12;  // m
constexpr double kSmall = 0.010;    // m

// Programs for stereo cameras, in a room of 3.2 x 2.6 x 4.4 m.
class Stereo : public MonoProgram {
 protected:
  explicit Stereo(const std::string& name = "stereo_folder") : MonoProgram(name) {}

  // Expects exit code 0 and a pose for every frame.
  ProgramResult ExpectMapOf(const Arguments& arguments) const {
    ProgramResult result = Run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(Summary()["trajectory"]["coverage"], 1.0);
    return result;
  }
  double Ate() const { return Summary()["trajectory"]["ate_rmse_m"].get<double>(); }
  std::string WriteSettings(double baseline) {
    const PinholeCamera& camera = room_.camera();
    return folder_.Write(
        "camera.yaml",
        fmt::format("Camera.fx: {}\nCamera.fy: {}\nCamera.cx: {}\nCamera.cy: {}\nCamera.width: {}\n"
                    "Camera.height: {}\nCamera.fps: 10\nCamera.bf: {}\n",
                    camera.fx, camera.fy, camera.cx, camera.cy, camera.width, camera.height,
                    baseline * camera.fx));
  }
  double Scale() const {
    const Trajectory poses = Poses();
    const double moved =
        (poses.back().world_from_cam.translation - poses.front().world_from_cam.translation).norm();
    return moved / (MadeRoom::Pose(kFrames - 1).translation - MadeRoom::Pose(0).translation).norm();
  }

  MadeRoom room_;
};

TEST_F(Stereo, AFolderOfPairsIsTrackedInMetres) {
  room_.WritePairs(path_, "left", "right", kFrames, kBaseline);
  const ProgramResult result = ExpectMapOf({path_, "--settings", WriteSettings(kBaseline)});
  ExpectParts(result.output, {"stereo: baseline 0.1200 m"});
  EXPECT_LT(Ate(), kSmall);
  EXPECT_EQ(Summary()["trajectory"]["alignment"], "se3");
  EXPECT_NEAR(Scale(), 1.0, 0.01);
}

TEST_F(Stereo, MasksOfTheRightImagesBelongToThoseOfTheLeftOnes) {
  constexpr int kFew = 4;
  room_.WritePairs(path_, "left", "right", kFew, kBaseline);
  const auto write = [&](const std::string& name, const std::string& text) {
    for (int i = 0; i < kFew; ++i) {
      folder_.Write(fmt::format("{}/{:06}.txt", name, i), text);
    }
    return (folder_.path() / name).string();
  };
  const std::string cup = "41 0.4 0.4 0.6 0.4 0.6 0.6 0.4 0.6\n";
  const std::string left = write("masks", cup);
  const std::string right = write("masks_right", cup + "0 0.1 0.4 0.3 0.4 0.3 0.6 0.1 0.6\n" +
                                                     "73 0.1 0.4 0.3 0.4 0.3 0.6 0.1 0.6\n");
  const std::string settings = WriteSettings(kBaseline);
  ExpectRefusal({path_, "--settings", settings, "--masks-right", right}, {"--masks"});
  const ProgramResult result =
      ExpectMapOf({path_, "--settings", settings, "--masks", left, "--masks-right", right});
  ExpectParts(result.output, {"right masks: " + right + " (yolo-seg)"});
  // The book, which is not in the left images, but not the person, whose class is dynamic.
  EXPECT_GE(Summary()["objects"]["rejections"]["mask_not_in_left"], kFew);
  EXPECT_LE(Summary()["objects"]["rejections"]["mask_not_in_left"], 2 * kFew);
}

// Both cameras are turned by 6 degrees about an axis across their baseline.
TEST_F(Stereo, PosesAreThoseOfTheLeftCameraAsRead) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.1, Eigen::Vector3d(0.0, 0.8, 0.6)));
  room_.WritePairs(path_, "left", "right", kFrames, kBaseline, turn);
  const Eigen::Vector3d right = turn.conjugate() * Eigen::Vector3d(kBaseline, 0.0, 0.0);
  const PinholeCamera& camera = room_.camera();
  std::string settings = fmt::format(
      "Camera.width: {}\nCamera.height: {}\nCamera.fps: 10\nStereo.T_c1_c2: !!opencv-matrix\n"
      "  rows: 4\n  cols: 4\n  dt: f\n  data: [1,0,0,{}, 0,1,0,{}, 0,0,1,{}, 0,0,0,1]\n",
      camera.width, camera.height, right.x(), right.y(), right.z());
  for (const char* const name : {"Camera1", "Camera2"}) {
    settings += fmt::format("{0}.fx: {1}\n{0}.fy: {2}\n{0}.cx: {3}\n{0}.cy: {4}\n", name, camera.fx,
                            camera.fy, camera.cx, camera.cy);
  }
  ExpectMapOf({path_, "--settings", folder_.Write("turned.yaml", settings)});
  EXPECT_LT(Ate(), kSmall);
  const auto turned_by = [](const Rigid3& from, const Rigid3& to) {
    return from.rotation.conjugate() * to.rotation;
  };
  const Rigid3 turned{turn, Eigen::Vector3d::Zero()};
  const Trajectory poses = Poses();
  // Those of the rectified camera would differ by a degree.
  EXPECT_LT(turned_by(poses.front().world_from_cam, poses.back().world_from_cam)
                .angularDistance(
                    turned_by(MadeRoom::Pose(0) * turned, MadeRoom::Pose(kFrames - 1) * turned)),
            0.004);
}

TEST_F(Stereo, WrongPairsAreRefusedBeforeTheFirstFrame) {
  room_.WritePairs(path_, "left", "right", 3, kBaseline);
  const std::string settings = WriteSettings(kBaseline);
  ExpectRefusal({path_}, {path_, "has no camera.yaml", "--settings FILE"});
  fs::rename(fs::path(path_) / "left", fs::path(path_) / "other");
  fs::rename(fs::path(path_) / "right", fs::path(path_) / "left");
  fs::rename(fs::path(path_) / "other", fs::path(path_) / "right");
  ExpectRefusal({path_, "--settings", settings}, {path_, "left and right are swapped"});
  fs::remove_all(fs::path(path_) / "right");
  fs::copy(fs::path(path_) / "left", fs::path(path_) / "right");
  ExpectRefusal({path_, "--settings", settings}, {path_, "the same image"});
  ExpectRefusal({path_, "--settings", WriteSettings(0.0)}, {"Camera.bf"});
}

TEST_F(Stereo, SettingsWithoutABaselineAreRefused) {
  room_.WritePairs(path_, "left", "right", 3, kBaseline);
  std::string text = ReadFile(WriteSettings(kBaseline));
  text.erase(text.find("Camera.bf"));
  const std::string one = folder_.Write("one.yaml", text);
  ExpectRefusal({path_, "--settings", one}, {one, "has no baseline", "Camera.bf"});
  EXPECT_EQ(Run({path_, "--settings", one, "--set",
                 fmt::format("Camera.bf={}", kBaseline * room_.camera().fx)})
                .exit_code,
            0);
}

TEST_F(Stereo, ImagesThatAreRectifiedAreNotResized) {
  room_.WritePairs(path_, "left", "right", 3, kBaseline);
  const std::string text = ReadFile(WriteSettings(kBaseline));
  const std::string bent = folder_.Write("bent.yaml", text + "Camera.k1: 0.01\n");
  ExpectRefusal({path_, "--settings", bent, "--set", "Camera.imageScale=0.5"},
                {bent, "Camera.imageScale"});
}

TEST_F(Stereo, AWrongBaselineIsWarnedOf) {
  room_.WritePairs(path_, "left", "right", kFrames, kBaseline);
  ExpectParts(Run({path_, "--settings", WriteSettings(kBaseline / 600.0)}).errors,
              {"warning: the baseline is 0.0002 m, expected 0.01 to 3 m"});
  const ProgramResult wide =
      Run({path_, "--settings", WriteSettings(2.0 * kBaseline), "--overwrite"});
  EXPECT_EQ(wide.errors.find("warning: the baseline is"), std::string::npos) << wide.errors;
  ExpectParts(wide.errors, {"times as large as the ground truth; is the baseline"});
  EXPECT_EQ(wide.errors.find("DepthMapFactor"), std::string::npos);
}

// The balls of a desk, whose outlines are those of ellipsoids. A camera that has hardly moved sees
// them from one side only, so the lines of the right images tell how far away they are.
TEST_F(Stereo, LinesOfTheRightImagesPlaceObjectsBetter) {
  const std::string desk = folder_.path() / "desk";
  ASSERT_EQ(RunProgram("make_synthetic", {desk, "--stereo", "0.12", "--frames", "30", "--quiet"})
                .exit_code,
            0);
  const auto centre_error = [&](const Arguments& more) {
    Arguments arguments = {desk, "--masks", desk + "/masks"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ExpectMapOf(arguments);
    const ProgramResult result = RunProgram(
        "hullslam",
        {"evaluate", "objects", output_, "--groundtruth", desk + "/groundtruth_objects.json"});
    std::smatch found;
    const std::regex balls("ellipsoid +3 mapped: mean centre error ([0-9.]+) %");
    EXPECT_TRUE(std::regex_search(result.output, found, balls)) << result.output << result.errors;
    return found.empty() ? 0.0 : std::stod(found[1]);
  };
  const double left = centre_error({});
  const double both = centre_error({"--masks-right", desk + "/masks_right"});
  EXPECT_GT(both, 0.0);
  EXPECT_LT(both, 0.8 * left);
}

class StereoBag : public Stereo {
 protected:
  StereoBag() : Stereo("stereo_bag") {}

  // The messages of a recording of the room.
  std::vector<MadeMessage> Messages(MessageCoding coding) const {
    const PinholeCamera& camera = room_.camera();
    const auto width = static_cast<uint32_t>(camera.width);
    const auto height = static_cast<uint32_t>(camera.height);
    std::vector<MadeMessage> messages;
    for (const std::string side : {"left", "right"}) {
      uint64_t time = 1'000'000'000;
      messages.push_back({"/" + side + "/camera_info", "sensor_msgs/CameraInfo", time,
                          MadeCameraInfo(coding, width, height, "plumb_bob", {}, camera.fx,
                                         side == "left" ? 0.0 : kBaseline)});
      for (const fs::path& file : ListImages(fs::path(path_) / side)) {
        const cv::Mat image = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
        messages.push_back({"/" + side + "/image", "sensor_msgs/Image", time,
                            MadeImage(coding, time, "mono8", width, height,
                                      std::string(image.datastart, image.dataend))});
        time += 100'000'000;
      }
    }
    return messages;
  }
};

TEST_F(StereoBag, TwoTopicsAreTrackedInMetres) {
  room_.WritePairs(path_, "left", "right", kFrames, kBaseline);
  const std::string bag =
      folder_.Write("pairs.mcap", MadeMcap(Messages(MessageCoding::kCdr), "zstd"));
  const ProgramResult result = ExpectMapOf({bag});
  ExpectParts(result.output,
              {"stereo: baseline 0.1200 m", "left images: /left/image",
               "cameras: /left/camera_info (raw images: K and D) and /right/camera_info (raw "
               "images: K and D)"});
  EXPECT_NEAR(Scale(), 1.0, 0.01);
  const std::string poses = ReadFile(output_ / "trajectory.txt");
  for (const fs::path& other :
       {WriteMadeSqlite(folder_.path() / "pairs.db3", Messages(MessageCoding::kCdr)),
        folder_.Write("pairs.bag", MadeRos1(Messages(MessageCoding::kRos1), "bz2"))}) {
    ExpectMapOf({other.string(), "--overwrite"});
    EXPECT_EQ(ReadFile(output_ / "trajectory.txt"), poses) << other;
  }
  ExpectRefusal({bag, "--image-topic", "/right/image", "--right-topic", "/left/image"},
                {bag, "left and right are swapped"});
}

class StereoEuroc : public Stereo {
 protected:
  StereoEuroc() : Stereo("stereo_euroc") {}
};

TEST_F(StereoEuroc, ARealPairIsTracked) {
  const auto data = FindTestData("zed2_realtime_105");
  if (!data) {
    GTEST_SKIP() << "the pair of a ZED 2 is not on this machine";
  }
  const ProgramResult result = ExpectMapOf({data->string(), "--last", "40"});
  ExpectParts(result.output, {"stereo: baseline 0.1200 m"});
  EXPECT_LT(Ate(), 0.01);
}

class StereoKitti : public Stereo {
 protected:
  StereoKitti() : Stereo("stereo_kitti") {}
};

// The images and the settings are half as large as calib.txt says.
TEST_F(StereoKitti, TheCameraOfTheSettingsTakesThePlaceOfTheCalibration) {
  room_.WritePairs(path_, "image_0", "image_1", kFrames, kBaseline);
  std::string times;
  for (int i = 0; i < kFrames; ++i) {
    times += fmt::format("{}\n", 0.1 * i);
  }
  folder_.Write(fs::path(path_).filename().string() + "/times.txt", times);
  const PinholeCamera& camera = room_.camera();
  const double fx = 2.0 * camera.fx;
  folder_.Write(fs::path(path_).filename().string() + "/calib.txt",
                fmt::format("P0: {0} 0 {1} 0 0 {0} {2} 0 0 0 1 0\n"
                            "P1: {0} 0 {1} {3} 0 {0} {2} 0 0 0 1 0\n",
                            fx, 2.0 * camera.cx, 2.0 * camera.cy, -kBaseline * fx));
  const std::string settings = WriteSettings(kBaseline);
  ExpectMapOf({path_, "--settings", settings});
  EXPECT_LT(Ate(), kSmall);
  EXPECT_NEAR(Scale(), 1.0, 0.01);
  const std::string bent = folder_.Write("bent.yaml", ReadFile(settings) + "Camera.k1: 0.01\n");
  ExpectRefusal({path_, "--settings", bent, "--set", "Camera.imageScale=0.5"},
                {bent, "Camera.imageScale"});
}

TEST_F(StereoKitti, ARealPairIsTracked) {
  const auto data = FindTestData("kitti_pairs_seq1");
  if (!data) {
    GTEST_SKIP() << "the pairs of KITTI are not on this machine";
  }
  ExpectMapOf({data->string()});
  EXPECT_LT(Ate(), 0.15) << "of 59.9 m";
}

}  // namespace
}  // namespace hullslam
