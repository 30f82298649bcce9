// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/nerfstudio.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "support/made_export.h"

namespace hullslam {
namespace {

using Json = nlohmann::json;

TEST(Transforms, HaveTheAxesOfOpenGl) {
  const Rigid3 world_from_cam(ExpSo3({0.1, -0.4, 0.2}), {1.0, 2.0, 3.0});
  const std::vector<NerfstudioFrame> frames = {{"images/a.png", {}, {}, world_from_cam}};
  const Json json = Json::parse(FormatTransforms(DistortedCamera(), frames, "points.ply"));
  const Json& rows = json["frames"][0]["transform_matrix"];
  const auto apply = [&](const Eigen::Vector4d& point) {
    Eigen::Vector4d moved = Eigen::Vector4d::Zero();
    for (size_t i = 0; i < 4; ++i) {
      for (size_t j = 0; j < 4; ++j) {
        moved[static_cast<Eigen::Index>(i)] +=
            rows[i][j].get<double>() * point[static_cast<Eigen::Index>(j)];
      }
    }
    return moved;
  };
  // A point one metre before the camera has z = -1 with OpenGL's axes, and one above has y = 1.
  const Eigen::Vector3d before = world_from_cam * Eigen::Vector3d(0.0, 0.0, 1.0);
  const Eigen::Vector3d above = world_from_cam * Eigen::Vector3d(0.0, -1.0, 0.0);
  EXPECT_NEAR((apply({0.0, 0.0, -1.0, 1.0}).head<3>() - before).norm(), 0.0, 1e-12);
  EXPECT_NEAR((apply({0.0, 1.0, 0.0, 1.0}).head<3>() - above).norm(), 0.0, 1e-12);
  EXPECT_EQ(apply({0.0, 0.0, 0.0, 1.0})[3], 1.0);
}

TEST(Transforms, NameTheCameraAndTheFiles) {
  const PinholeCamera camera = DistortedCamera();
  std::vector<NerfstudioFrame> frames = {{"images/a.png", "depths/a.png", "masks/a.png", {}}};
  Json json = Json::parse(FormatTransforms(camera, frames, "points.ply"));
  EXPECT_EQ(json["fl_x"], camera.fx);
  EXPECT_EQ(json["cx"], camera.cx + 0.5);
  EXPECT_EQ(json["w"], camera.width);
  EXPECT_EQ(json["k1"], 0.0);
  EXPECT_EQ(json["ply_file_path"], "points.ply");
  EXPECT_EQ(json["depth_unit_scale_factor"], 0.001);
  EXPECT_EQ(json["frames"][0]["file_path"], "images/a.png");
  EXPECT_EQ(json["frames"][0]["depth_file_path"], "depths/a.png");
  EXPECT_EQ(json["frames"][0]["mask_path"], "masks/a.png");
  frames[0].depth = frames[0].mask = "";
  json = Json::parse(FormatTransforms(camera, frames, "points.ply"));
  EXPECT_FALSE(json.contains("depth_unit_scale_factor"));
  EXPECT_FALSE(json["frames"][0].contains("depth_file_path"));
  EXPECT_FALSE(json["frames"][0].contains("mask_path"));
}

// The depth image of a plane at this distance, in units of 1 / `units` m.
cv::Mat DepthOfPlane(const PinholeCamera& camera, double metres, double units) {
  return cv::Mat(camera.height, camera.width, CV_16UC1, cv::Scalar(metres * units));
}

TEST(DepthImages, AreInMillimetres) {
  PinholeCamera camera = DistortedCamera();
  const ExportCamera view(camera);
  cv::Mat depth = DepthOfPlane(camera, 1.5, 5000.0);
  const cv::Mat image = MakeDepthImage(depth, 5000.0, view);
  ASSERT_EQ(image.type(), CV_16UC1);
  EXPECT_EQ(image.cols, view.camera().width);
  EXPECT_EQ(image.at<uint16_t>(50, 50), 1500);
  EXPECT_EQ(
      MakeDepthImage(cv::Mat::zeros(depth.size(), CV_16UC1), 5000.0, view).at<uint16_t>(50, 50), 0);
  const cv::Mat metres(depth.size(), CV_32FC1, cv::Scalar(2.25));
  EXPECT_EQ(MakeDepthImage(metres, 1.0, view).at<uint16_t>(50, 50), 2250);
  const cv::Mat far(depth.size(), CV_32FC1, cv::Scalar(70.0));
  EXPECT_EQ(MakeDepthImage(far, 1.0, view).at<uint16_t>(50, 50), 0) << "does not fit into 16 bits";
}

TEST(DepthImages, HaveTheUnitsThatTheKeypointsTell) {
  const PinholeCamera camera = DistortedCamera();
  FrameFeatures features;
  for (int i = 0; i < 20; ++i) {
    Keypoint keypoint;
    keypoint.undistorted = {20.0f + 5.0f * static_cast<float>(i), 60.0f};
    features.keypoints.push_back(keypoint);
    features.depth.push_back(i < 12 ? 1.5f : 0.0f);
  }
  const auto units = MeasureDepthUnits(features, camera, DepthOfPlane(camera, 1.5, 5000.0));
  ASSERT_TRUE(units);
  EXPECT_NEAR(*units, 5000.0, 1e-3);
  features.depth.assign(20, 0.0f);
  EXPECT_FALSE(MeasureDepthUnits(features, camera, DepthOfPlane(camera, 1.5, 5000.0)));
}

TEST(DepthImages, TenKeypointsAreNeededForTheUnits) {
  const PinholeCamera camera = DistortedCamera();
  const cv::Mat depth = DepthOfPlane(camera, 1.5, 1000.0);
  FrameFeatures features;
  for (int i = 0; i < 9; ++i) {
    features.keypoints.emplace_back().undistorted = {20.0f + 5.0f * static_cast<float>(i), 60.0f};
    features.depth.push_back(1.5f);
  }
  EXPECT_FALSE(MeasureDepthUnits(features, camera, depth));
  features.keypoints.push_back(features.keypoints.back());
  features.depth.push_back(1.5f);
  EXPECT_TRUE(MeasureDepthUnits(features, camera, depth));
}

TEST(DepthImages, AreRoundedToTheNearestMillimetre) {
  const PinholeCamera camera = DistortedCamera();
  const cv::Mat depth = DepthOfPlane(camera, 1.4998, 5000.0);
  EXPECT_EQ(MakeDepthImage(depth, 5000.0, ExportCamera(camera)).at<uint16_t>(50, 50), 1500);
}

}  // namespace
}  // namespace hullslam
