// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/mask_camera.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "frame/made_masks.h"
#include "hullslam/geometry/dual_quadric.h"
#include "support/fisheye_camera.h"

namespace hullslam {
namespace {

using Outlines = std::vector<std::vector<Eigen::Vector2d>>;

// A circle of raw pixels about the direction at this angle to the right of the axis.
Outlines CircleAt(const PinholeCamera& camera, double degrees, double radius) {
  const double angle = degrees * std::numbers::pi / 180.0;
  const Eigen::Vector2d center = camera.Distort(camera.Project({std::tan(angle), 0.2, 1.0}));
  Outlines outlines(1);
  for (int i = 0; i < 60; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / 60.0;
    outlines[0].emplace_back(center + radius * Eigen::Vector2d(std::cos(turn), std::sin(turn)));
  }
  return outlines;
}

TEST(MaskCamera, IsTheUndistortedImageOfAPinhole) {
  const PinholeCamera camera = DistortedCamera();
  const MaskCamera view(camera, Outlines{{{100.0, 100.0}, {150.0, 100.0}, {120.0, 160.0}}});
  EXPECT_EQ(view.Undistort({33.0, 44.0}), camera.Undistort({33.0, 44.0}));
  EXPECT_EQ(view.Distort({33.0, 44.0}), camera.Distort({33.0, 44.0}));
  EXPECT_EQ(view.focal(), camera.fx);
  EXPECT_EQ(view.DepthOf({1.0, 2.0, 3.0}), 3.0);
  EXPECT_TRUE(view.IsAtBorder(camera.Undistort({4.0, 200.0}), 5.0));
  EXPECT_FALSE(view.IsAtBorder(camera.Undistort({8.0, 200.0}), 5.0));
}

// The view has as many pixels as the raw image, also where the undistorted image is stretched.
TEST(MaskCamera, KeepsTheScaleOfTheRawImageAtTheRim) {
  const PinholeCamera camera = FisheyeCamera();
  for (const double degrees : {0.0, 30.0, 60.0, 72.0}) {
    const Outlines outlines = CircleAt(camera, degrees, 10.0);
    const MaskCamera view(camera, outlines);
    double area = 0.0;
    for (size_t i = 0; i < outlines[0].size(); ++i) {
      const Eigen::Vector2d a = view.Undistort(outlines[0][i]);
      const Eigen::Vector2d b = view.Undistort(outlines[0][(i + 1) % outlines[0].size()]);
      area += 0.5 * (a.x() * b.y() - a.y() * b.x());
      EXPECT_LT((view.Distort(a) - outlines[0][i]).norm(), 1e-6);
    }
    EXPECT_NEAR(area, std::numbers::pi * 100.0, 0.02 * std::numbers::pi * 100.0) << degrees;
  }
}

TEST(MaskCamera, TheLargestAngleOfAFisheyeIsABorder) {
  const PinholeCamera camera = FisheyeCamera();
  PinholeCamera large = camera;
  large.width = 1000;
  large.cx = 500.0;
  const MaskCamera view(large, CircleAt(large, 70.0, 10.0));
  const double limit = 244.0 * 1.396 * 1.001;  // px, about
  EXPECT_TRUE(view.IsAtBorder(view.Undistort({large.cx + limit + 30.0, large.cy}), 5.0));
  EXPECT_FALSE(view.IsAtBorder(view.Undistort({large.cx + limit - 20.0, large.cy}), 5.0));
}

// The tangents of an ellipsoid's outline in the view are tangents of its projected ellipse.
TEST(MaskCamera, LinesAndEllipsesStayThoseOfTheObject) {
  const PinholeCamera camera = FisheyeCamera();
  const MaskCamera view(camera, CircleAt(camera, 65.0, 10.0));
  const Ellipse in_view{.center = view.Undistort(CircleAt(camera, 65.0, 0.0)[0][0]),
                        .shape = Eigen::Vector2d(400.0, 225.0).asDiagonal()};
  Detection detection;
  detection.ellipse = in_view;
  detection.hull = in_view.Polygon(64);
  detection.contour = detection.hull;
  for (const Eigen::Vector2d& direction :
       {Eigen::Vector2d(1.0, 0.0), {0.0, 1.0}, {-0.6, 0.8}, {-0.8, -0.6}}) {
    detection.lines.push_back(
        {.line = {.normal = direction,
                  .offset = -direction.dot(in_view.center) - in_view.HalfExtent(direction)}});
  }
  view.ToUndistorted(detection);
  ASSERT_TRUE(detection.ellipse);
  for (const SilhouetteLine& line : detection.lines) {
    EXPECT_NEAR(line.line.normal.norm(), 1.0, 1e-12);
    EXPECT_NEAR(line.line.SignedDistance(detection.ellipse->center) +
                    detection.ellipse->HalfExtent(line.line.normal),
                0.0, 1e-6);
  }
  // A point of the view keeps its raw pixel.
  for (size_t i = 0; i < detection.hull.size(); ++i) {
    EXPECT_LT((camera.Distort(detection.hull[i]) - view.Distort(in_view.Polygon(64)[i])).norm(),
              1e-6);
  }
  EXPECT_EQ(detection.box.max().x(),
            std::max_element(detection.hull.begin(), detection.hull.end(), [](auto& a, auto& b) {
              return a.x() < b.x();
            })->x());
}

}  // namespace
}  // namespace hullslam
