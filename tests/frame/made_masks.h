// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/instance_mask.h"
#include "hullslam/geometry/conic.h"

namespace hullslam {

// The camera of freiburg1, which has strong distortion (config/TUM1.yaml).
inline PinholeCamera DistortedCamera() {
  PinholeCamera camera;
  camera.fx = 517.306408;
  camera.fy = 516.469215;
  camera.cx = 318.643040;
  camera.cy = 255.313989;
  camera.k1 = 0.262383;
  camera.k2 = -0.953104;
  camera.p1 = -0.005358;
  camera.p2 = 0.002628;
  camera.k3 = 1.163314;
  return camera;
}

inline PinholeCamera PlainCamera() {
  PinholeCamera camera;
  camera.fx = camera.fy = 500.0;
  camera.cx = 320.0;
  camera.cy = 240.0;
  return camera;
}

inline Ellipse MakeEllipse(const Eigen::Vector2d& center, double a, double b, double angle) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
  return {center, turn * Eigen::Vector2d(a * a, b * b).asDiagonal() * turn.transpose()};
}

// The mask of an ellipse in the undistorted image. It is cut at the border of the raw image.
inline InstanceMask MaskOf(const Ellipse& ellipse, const PinholeCamera& camera) {
  InstanceMask mask{.label = "cup", .score = 0.9, .shape = MaskShape::kContour, .outlines = {{}}};
  for (const Eigen::Vector2d& p : ellipse.Polygon(720)) {
    const Eigen::Vector2d raw = camera.Distort(p);
    mask.outlines[0].emplace_back(std::clamp(raw.x(), 0.0, camera.width - 1.0),
                                  std::clamp(raw.y(), 0.0, camera.height - 1.0));
  }
  return mask;
}

inline std::vector<Eigen::Vector2d> Rectangle(double x, double y, double width, double height) {
  return {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
}

inline InstanceMask RectangleMask(double x, double y, double width, double height,
                                  const std::string& label = "book", double score = 0.8) {
  return {.label = label,
          .score = score,
          .shape = MaskShape::kContour,
          .outlines = {Rectangle(x, y, width, height)}};
}

}  // namespace hullslam
