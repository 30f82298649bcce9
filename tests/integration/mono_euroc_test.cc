// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "support/mono_program.h"
#include "support/rendered_desk.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr int kEurocFrames = 16;

// The pose of the camera in the body: a rotation by 90 degrees about z, and a shift.
const Rigid3 kBodyFromCam{Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ())),
                          {0.1, 0.2, 0.3}};
constexpr const char* kSensor =
    "sensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n"
    "  data: [0.0, -1.0, 0.0, 0.1, 1.0, 0.0, 0.0, 0.2, 0.0, 0.0, 1.0, 0.3, 0.0, 0.0, 0.0, 1.0]\n"
    "rate_hz: 30\nresolution: [{}, {}]\ncamera_model: pinhole\nintrinsics: [{}, {}, {}, {}]\n"
    "distortion_model: radial-tangential\ndistortion_coefficients: [{}, {}, {}, {}]\n";

uint64_t Nanoseconds(double seconds) {
  return static_cast<uint64_t>(std::llround(seconds * 1e6)) * 1000;
}

class MonoEuroc : public MonoProgram {
 protected:
  MonoEuroc() : MonoProgram("mono_euroc") {}

  void WriteSensor(const PinholeCamera& camera) const {
    folder_.Write(
        "sequence/mav0/cam0/sensor.yaml",
        fmt::format(fmt::runtime(kSensor), camera.width, camera.height, camera.fx, camera.fy,
                    camera.cx, camera.cy, camera.k1, camera.k2, camera.p1, camera.p2));
  }

  // Writes the images under their stamps, and the list of them.
  void WriteImages(const std::vector<FramePaths>& frames) const {
    fs::create_directories(Camera() / "data");
    std::string list = "#timestamp [ns],filename\r\n";
    for (const FramePaths& frame : frames) {
      const uint64_t stamp = Nanoseconds(frame.timestamp);
      cv::imwrite((Camera() / fmt::format("data/{}.png", stamp)).string(),
                  cv::imread(frame.image.string(), cv::IMREAD_GRAYSCALE));
      list += fmt::format("{0},{0}.png\r\n", stamp);
    }
    folder_.Write("sequence/mav0/cam0/data.csv", list);
  }

  void WriteStates(const Trajectory& cameras) const {
    std::string states = "#timestamp, p_RS_R_x [m], ...\r\n";
    for (const StampedPose& pose : cameras) {
      const Rigid3 body = pose.world_from_cam * Inverse(kBodyFromCam);
      const Eigen::Vector3d& t = body.translation;
      const Eigen::Quaterniond& q = body.rotation;
      states += fmt::format("{},{},{},{},{},{},{},{},0,0,0\r\n", Nanoseconds(pose.timestamp), t.x(),
                            t.y(), t.z(), q.w(), q.x(), q.y(), q.z());
    }
    folder_.Write("sequence/mav0/state_groundtruth_estimate0/data.csv", states);
  }

  // Writes a sequence of black images.
  void WriteBlack(int frames) const {
    const fs::path black = folder_.path() / "black.png";
    cv::imwrite(black.string(), cv::Mat(480, 640, CV_8UC1, cv::Scalar(0)));
    std::vector<FramePaths> paths;
    for (int i = 0; i < frames; ++i) {
      paths.push_back({1000.0 + 0.05 * i, black});
    }
    WriteImages(paths);
    WriteSensor({.fx = 500.0, .fy = 500.0, .cx = 319.5, .cy = 239.5});
  }

  fs::path Camera() const { return fs::path(path_) / "mav0/cam0"; }
};

TEST_F(MonoEuroc, MakesAMapWithTheCameraOfTheSequence) {
  const RenderedDesk desk(kEurocFrames);
  const ImageSequence images = desk.images();
  WriteImages(images.frames);
  WriteSensor(desk.camera());
  WriteStates(ReadGroundtruth(images).value());
  ExpectMap({path_}, kEurocFrames);
  EXPECT_LE(Ate(), 0.005);
  EXPECT_EQ(Summary()["trajectory"]["pairs"], kEurocFrames);
  EXPECT_NEAR(ReadTrajectory(output_ / "groundtruth.txt").front().timestamp,
              images.frames.front().timestamp, 1e-6);
  const std::string poses = ReadFile(output_ / "trajectory.txt");
  ExpectMap({path_ + "/mav0", "--settings", desk.settings()}, kEurocFrames);
  EXPECT_TRUE(ReadFile(output_ / "trajectory.txt") == poses) << "the camera is the same";
  fs::remove_all(path_ + "/mav0/state_groundtruth_estimate0");
  ExpectMap({path_, "--quiet"}, kEurocFrames);
  EXPECT_TRUE(Summary()["trajectory"]["ate_rmse_m"].is_null());
}

TEST_F(MonoEuroc, BlackImagesMakeNoMap) {
  WriteBlack(12);
  ExpectNoMap({path_}, 12, "too few features");
}

TEST_F(MonoEuroc, BrokenFoldersAreRefused) {
  ExpectRefusal({path_}, {path_, "mav0/cam0"});
  WriteBlack(2);
  const std::string good = ReadFile(Camera() / "sensor.yaml");
  WriteSensor({.fx = 500.0, .fy = 500.0, .cx = 375.5, .cy = 239.5, .width = 752});
  ExpectRefusal({path_}, {".png", "640x480", "752x480"});
  fs::remove(Camera() / "sensor.yaml");
  ExpectRefusal({path_}, {"has neither cam0/sensor.yaml nor a camchain"});
  folder_.Write("sequence/mav0/cam0/sensor.yaml", good);
  folder_.Write("sequence/mav0/cam0/data.csv", "1000,1000.png,7\n");
  ExpectRefusal({path_}, {"data.csv:1: 3 column(s), expected 2"});
}

TEST_F(MonoEuroc, GivenSettingsReplaceThoseOfTheSequence) {
  WriteBlack(2);
  const std::string small = folder_.Write(
      "small.yaml",
      "%YAML:1.0\nCamera.fx: 250.0\nCamera.fy: 250.0\nCamera.cx: 159.5\nCamera.cy: 119.5\n"
      "Camera.width: 320\nCamera.height: 240\n");
  ExpectRefusal({path_, "--settings", small}, {".png", "640x480", "320x240"});
  ExpectRefusal({"none", small, path_}, {".png", "640x480", "320x240"});
  ExpectRefusal({path_, "--set", "Camera.fx=wide"}, {"--set", "Camera.fx is 'wide'"});
}

}  // namespace
}  // namespace hullslam
