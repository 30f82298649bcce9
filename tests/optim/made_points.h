// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "camera/point_measurement.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/rigid3.h"
#include "optim/bundle_points.h"
#include "support/random_geometry.h"

namespace hullslam {

// Points that cameras on a short path see: some with depth, some observations wrong by 30 px, and
// some that count less. Poses and positions are some centimetres away from the truth.
struct MadePoints {
  explicit MadePoints(size_t pose_count, size_t point_count = 40, uint64_t seed = 1) {
    RandomGeometry random(seed);
    std::vector<Rigid3> true_poses;
    for (size_t i = 0; i < pose_count; ++i) {
      true_poses.push_back({ExpSo3(0.05 * random.Vector(1.0)),
                            Eigen::Vector3d(-0.1 * static_cast<double>(i), 0.0, 0.0)});
      poses.push_back(random.Pose(0.01, 0.02) * true_poses.back());
    }
    for (size_t i = 0; i < point_count; ++i) {
      const Eigen::Vector3d point = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 3.0);
      points.AddPoint(point + random.Vector(0.02));
      for (size_t k = 0; k < pose_count; ++k) {
        if ((i + k) % 4 != 0) {
          AddView(true_poses[k] * point, k, i + k, random);
        }
      }
    }
  }

  const PinholeCamera camera{.fx = 500.0, .fy = 510.0, .cx = 320.0, .cy = 240.0, .bf = 40.0};
  std::vector<Rigid3> poses;  // cam_from_world
  internal::BundlePoints points;

 private:
  void AddView(const Eigen::Vector3d& in_camera, size_t pose, size_t number,
               RandomGeometry& random) {
    const Eigen::Vector3d image = ProjectRgbd(camera, in_camera);
    const double wrong = number % 7 == 0 ? 30.0 : 0.0;
    PointMeasurement measurement;
    measurement.measured = image + random.Vector(0.5) + Eigen::Vector3d(wrong, 0.0, 0.0);
    measurement.inverse_sigma << 1.2, 1.2, number % 3 == 0 ? 0.0 : 0.9;
    points.AddView(measurement, pose, number % 5 == 0 ? 0.25 : 1.0);
  }
};

}  // namespace hullslam
