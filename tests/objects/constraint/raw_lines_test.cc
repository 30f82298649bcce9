// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/constraint/raw_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "costs/quadric_tangent.h"
#include "support/fisheye_camera.h"

namespace hullslam {
namespace {

// The hull of a square of raw pixels, and its right side as a line.
Detection SquareAt(const PinholeCamera& camera, const Eigen::Vector2d& center) {
  Detection detection;
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(-9.0, -9.0), {9.0, -9.0}, {9.0, 9.0}, {-9.0, 9.0}}) {
    detection.hull.push_back(camera.Undistort(center + corner));
  }
  const Eigen::Vector2d along = (detection.hull[2] - detection.hull[1]).normalized();
  const Eigen::Vector2d normal(along.y(), -along.x());
  detection.lines.push_back({.line = {.normal = normal, .offset = -normal.dot(detection.hull[1])}});
  return detection;
}

TEST(RawLines, DistancesAreThoseOfTheRawImage) {
  const PinholeCamera camera = FisheyeCamera();
  for (const Eigen::Vector2d& center :
       {Eigen::Vector2d(320.0, 240.0), {560.0, 240.0}, {580.0, 330.0}, {40.0, 120.0}}) {
    const Detection detection = SquareAt(camera, center);
    const auto lines = ScaleToRaw(camera, detection, detection.lines);
    ASSERT_EQ(lines.size(), 1u);
    // A point a fifth of a raw px to the right of an end of the side.
    const Eigen::Vector2d beyond = camera.Undistort(center + Eigen::Vector2d(9.2, -9.0));
    EXPECT_NEAR(lines[0].line.SignedDistance(beyond), 0.2, 0.02) << center.transpose();
    EXPECT_NEAR(lines[0].line.SignedDistance(detection.hull[1]), 0.0, 1e-9);
  }
}

TEST(RawLines, WithoutDistortionAreTheSame) {
  PinholeCamera camera = FisheyeCamera();
  camera.lens = LensModel::kBrown;
  camera.k1 = camera.k2 = camera.k3 = camera.k4 = 0.0;
  const Detection detection = SquareAt(camera, {500.0, 200.0});
  const auto lines = ScaleToRaw(camera, detection, detection.lines);
  EXPECT_EQ(lines[0].line.normal, detection.lines[0].line.normal);
  EXPECT_EQ(lines[0].line.offset, detection.lines[0].line.offset);
}

}  // namespace
}  // namespace hullslam
