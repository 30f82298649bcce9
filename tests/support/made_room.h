// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// A camera that moves in all directions through a room with textured walls. Its images can be
// written in the formats of published data sets. The true poses are those of a right-handed camera
// with y down.
class MadeRoom {
 public:
  // The camera of ICL-NUIM with images of 640 x 480 px divided by `reduction`.
  explicit MadeRoom(int reduction = 1)
      : camera_{.fx = 481.2 / reduction,
                .fy = 480.0 / reduction,
                .cx = 319.5 / reduction,
                .cy = 239.5 / reduction,
                .width = 640 / reduction,
                .height = 480 / reduction} {}

  const PinholeCamera& camera() const { return camera_; }

  // World from camera of a frame. The path is a helix, which no rotation turns into its mirror
  // image.
  static Rigid3 Pose(int frame) {
    const double t = 0.1 * frame;
    const Eigen::Quaterniond rotation = ExpSo3({0.25 * std::sin(t), 0.15 * t, 0.1 * t});
    return {rotation, {0.25 * std::sin(1.5 * t), 0.25 - 0.25 * std::cos(1.5 * t), 0.15 * t}};
  }

  struct Images {
    cv::Mat grey;      // CV_8UC1
    cv::Mat distance;  // CV_64FC1, m, along the rays
    cv::Mat depth;     // CV_16UC1, 5000 units per metre, along z
  };

  Images Render(int frame) const { return Render(Pose(frame)); }
  // The image of a second camera that is `baseline` (m) to the right.
  cv::Mat RenderRight(int frame, double baseline) const {
    return Render(Pose(frame) * Rigid3{Eigen::Quaterniond::Identity(), {baseline, 0.0, 0.0}}).grey;
  }

  Images Render(const Rigid3& pose) const {
    Images images{cv::Mat(camera_.height, camera_.width, CV_8UC1),
                  cv::Mat(camera_.height, camera_.width, CV_64FC1),
                  cv::Mat(camera_.height, camera_.width, CV_16UC1)};
    for (int v = 0; v < camera_.height; ++v) {
      for (int u = 0; u < camera_.width; ++u) {
        const Eigen::Vector3d ray = camera_.Unproject({u, v}, 1.0);
        const double z = DepthAlong(pose.translation, pose.rotation * ray);
        images.grey.at<uint8_t>(v, u) = Texture(pose * (z * ray));
        images.distance.at<double>(v, u) = z * ray.norm();
        images.depth.at<uint16_t>(v, u) = static_cast<uint16_t>(std::lround(5000.0 * z));
      }
    }
    return images;
  }

  // The pose of the same camera if the y axes of the camera and of the world point up.
  static Rigid3 PoseWithYUp(int frame) {
    const Eigen::DiagonalMatrix<double, 3> mirror(1.0, -1.0, 1.0);
    const Rigid3 pose = Pose(frame);
    const Eigen::Matrix3d rotation = mirror * pose.rotation.toRotationMatrix() * mirror;
    return {Eigen::Quaterniond(rotation), mirror * pose.translation};
  }

  // Writes ICL-NUIM's package with PNG images, with the frames 0, 1, ... The ground truth
  // `made.gt.freiburg` begins at index 1; it is that of cameras whose y axis points up or down.
  void WriteIclTum(const std::filesystem::path& folder, int frames, bool is_y_up) const {
    std::filesystem::create_directories(folder / "rgb");
    std::filesystem::create_directories(folder / "depth");
    std::ofstream associations(folder / "associations.txt");
    std::ofstream truth(folder / "made.gt.freiburg");
    for (int i = 0; i < frames; ++i) {
      const Images images = Render(i);
      cv::imwrite((folder / fmt::format("rgb/{}.png", i)).string(), images.grey);
      cv::imwrite((folder / fmt::format("depth/{}.png", i)).string(), images.depth);
      associations << fmt::format("{0} depth/{0}.png {0} rgb/{0}.png\n", i);
      if (i > 0) {
        truth << FormatPose(i, is_y_up ? PoseWithYUp(i) : Pose(i));
      }
    }
  }

  // Writes the left and right images into two folders of the sequence, and the true poses of the
  // left camera. The path is that of the rectified pair; both cameras are turned from it.
  void WritePairs(const std::filesystem::path& folder, const std::string& left,
                  const std::string& right, int frames, double baseline,
                  const Eigen::Quaterniond& turn = Eigen::Quaterniond::Identity()) const {
    std::filesystem::create_directories(folder / left);
    std::filesystem::create_directories(folder / right);
    std::ofstream truth(folder / "groundtruth.txt");
    for (int i = 0; i < frames; ++i) {
      const std::string name = fmt::format("{:06}.png", i);
      const Rigid3 pose = Pose(i) * Rigid3{turn, Eigen::Vector3d::Zero()};
      const Rigid3 of_right = Pose(i) * Rigid3{turn, {baseline, 0.0, 0.0}};
      cv::imwrite((folder / left / name).string(), Render(pose).grey);
      cv::imwrite((folder / right / name).string(), Render(of_right).grey);
      truth << FormatPose(0.1 * i, pose);
    }
  }

 private:
  static std::string FormatPose(double stamp, const Rigid3& pose) {
    const Eigen::Vector3d& t = pose.translation;
    const Eigen::Quaterniond& q = pose.rotation;
    return fmt::format("{} {:.8f} {:.8f} {:.8f} {:.8f} {:.8f} {:.8f} {:.8f}\n", stamp, t.x(), t.y(),
                       t.z(), q.x(), q.y(), q.z(), q.w());
  }

  // The number d for which `origin` + d * `direction` is on a wall. `origin` is inside the room.
  static double DepthAlong(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    const Eigen::Vector3d half(1.6, 1.3, 2.2);
    double nearest = std::numeric_limits<double>::max();
    for (int axis = 0; axis < 3; ++axis) {
      const double wall = direction[axis] < 0.0 ? -half[axis] : half[axis];
      if (direction[axis] != 0.0) {
        nearest = std::min(nearest, (wall - origin[axis]) / direction[axis]);
      }
    }
    return nearest;
  }

  // Squares of 8 cm with random grey values.
  static uint8_t Texture(const Eigen::Vector3d& point) {
    constexpr double kSide = 0.08;
    uint32_t hash = 17;
    for (int axis = 0; axis < 3; ++axis) {
      const auto cell = static_cast<int32_t>(std::floor(point[axis] / kSide + 0.25));
      hash = (hash ^ static_cast<uint32_t>(cell)) * 0x9E3779B1U;
      hash ^= hash >> 15;
    }
    return static_cast<uint8_t>(40 + hash % 176);
  }

  PinholeCamera camera_;
};

}  // namespace hullslam
