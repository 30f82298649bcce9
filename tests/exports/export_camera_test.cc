// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/export_camera.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "support/made_export.h"

namespace hullslam {
namespace {

// An image whose value at a raw pixel is a smooth function of the position.
cv::Mat MadeImage(const PinholeCamera& camera, bool of_columns) {
  cv::Mat image(camera.height, camera.width, CV_32FC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image.at<float>(y, x) = static_cast<float>(of_columns ? x : y);
    }
  }
  return image;
}

// The law of an undistorted image: its pixel shows what the raw image shows at the raw pixel of the
// same ray.
TEST(ExportCamera, APixelShowsTheRawPixelOfItsRay) {
  const PinholeCamera camera = DistortedCamera();
  const ExportCamera view(camera);
  const cv::Mat columns = view.Undistort(MadeImage(camera, true), cv::INTER_LINEAR);
  const cv::Mat rows = view.Undistort(MadeImage(camera, false), cv::INTER_LINEAR);
  ASSERT_EQ(columns.cols, view.camera().width);
  ASSERT_EQ(columns.rows, view.camera().height);
  for (int y = 0; y < rows.rows; y += 7) {
    for (int x = 0; x < rows.cols; x += 7) {
      const Eigen::Vector3d ray = view.camera().Unproject({x, y}, 1.0);
      const Eigen::Vector2d raw = camera.Distort(camera.Project(ray));
      // cv::remap rounds positions to 1/32 px.
      EXPECT_NEAR(columns.at<float>(y, x), raw.x(), 0.05);
      EXPECT_NEAR(rows.at<float>(y, x), raw.y(), 0.05);
    }
  }
}

TEST(ExportCamera, EveryPixelWasSeen) {
  const PinholeCamera camera = DistortedCamera();
  const ExportCamera view(camera);
  const double right = view.camera().width - 1.0;
  const double bottom = view.camera().height - 1.0;
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(right, 0.0), Eigen::Vector2d(0.0, bottom),
        Eigen::Vector2d(right, bottom)}) {
    const Eigen::Vector2d raw =
        camera.Distort(camera.Project(view.camera().Unproject(corner, 1.0)));
    EXPECT_GE(raw.minCoeff(), 0.0);
    EXPECT_LE(raw.x(), camera.width - 1.0);
    EXPECT_LE(raw.y(), camera.height - 1.0);
  }
  EXPECT_GT(view.camera().width, camera.width * 3 / 4);
}

TEST(ExportCamera, KeypointsMoveWithTheImage) {
  const PinholeCamera camera = DistortedCamera();
  const ExportCamera view(camera);
  const Eigen::Vector3d point(0.1, -0.2, 1.5);
  EXPECT_NEAR((view.FromUndistorted(camera.Project(point)) - view.camera().Project(point)).norm(),
              0.0, 1e-9);
  EXPECT_TRUE(view.Contains({0.0, 0.0}));
  EXPECT_FALSE(view.Contains({-1.0, 0.0}));
  EXPECT_FALSE(view.Contains({0.0, view.camera().height - 0.4}));
}

TEST(ExportCamera, WithoutDistortionTheImageStaysAsItIs) {
  PinholeCamera camera = DistortedCamera();
  camera.k1 = camera.k2 = camera.p1 = 0.0;
  const ExportCamera view(camera);
  EXPECT_EQ(view.camera(), camera);
  const cv::Mat image = MadeImage(camera, true);
  EXPECT_EQ(view.Undistort(image, cv::INTER_LINEAR).data, image.data);
}

// Pixels have whole numbers at their centres, so an image ends half a pixel beyond the last ones.
TEST(ExportCamera, ContainsTheWholePixelsAtTheBorder) {
  const ExportCamera view(DistortedCamera());
  const double right = view.camera().width - 1.0;
  const double bottom = view.camera().height - 1.0;
  EXPECT_TRUE(view.Contains({-0.4, -0.4}));
  EXPECT_TRUE(view.Contains({right + 0.4, bottom + 0.4}));
  EXPECT_FALSE(view.Contains({-0.6, 5.0}));
  EXPECT_FALSE(view.Contains({5.0, -0.6}));
  EXPECT_FALSE(view.Contains({right + 0.6, 5.0}));
  EXPECT_FALSE(view.Contains({5.0, bottom + 0.6}));
}

}  // namespace
}  // namespace hullslam
