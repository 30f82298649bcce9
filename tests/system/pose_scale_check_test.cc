// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/pose_scale_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace hullslam {
namespace {

// Views of a cup at (0, 0, 3) from a camera that moves to the right by 5 cm and turns a little each
// time. The unit of the poses is `scale` metres.
PoseScaleCheck Look(double scale, int views, const std::vector<std::string>& labels = {"cup"}) {
  PoseScaleCheck check;
  for (int i = 0; i < views; ++i) {
    const Eigen::Quaterniond rotation(
        Eigen::AngleAxisd(0.02 * std::sin(i), Eigen::Vector3d::UnitY()));
    const Rigid3 pose(rotation, Eigen::Vector3d(0.05 * i, 0.0, 0.0));
    const Eigen::Vector3d centre = Inverse(pose) * Eigen::Vector3d(0.0, 0.0, 3.0);
    std::vector<Eigen::Vector3d> points;
    for (int k = 0; k < 20; ++k) {
      points.emplace_back(centre + Eigen::Vector3d(0.002 * k - 0.02, 0.0, 0.001 * k - 0.01));
    }
    std::vector<Detection> detections;
    for (const std::string& label : labels) {
      Detection& detection = detections.emplace_back();
      detection.label = label;
      detection.points = PackedPoints<3>(points);
    }
    check.Add(detections, {rotation, pose.translation / scale});
  }
  return check;
}

TEST(PoseScaleCheck, TheUnitOfThePosesIsMeasured) {
  for (const double scale : {0.3, 1.0, 4.0}) {
    const std::optional<double> found = Look(scale, 15).Scale();
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found / scale, 1.0, 0.02);
  }
}

TEST(PoseScaleCheck, FewViewsOrThingsOfTheSameClassSayNothing) {
  EXPECT_FALSE(Look(1.0, 5).Scale());
  EXPECT_FALSE(Look(1.0, 15, {"cup", "cup"}).Scale());
}

}  // namespace
}  // namespace hullslam
