// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/matrix_pose.h"

#include <gtest/gtest.h>

#include "support/random_geometry.h"

namespace hullslam {
namespace {

TEST(MatrixPose, MovesPointsAsThePoseDoes) {
  RandomGeometry random(1);
  for (int i = 0; i < 20; ++i) {
    const Rigid3 pose = random.Pose(3.0, 2.0);
    const Eigen::Vector3d point = random.Vector(4.0);
    EXPECT_LT((MatrixPose(pose) * point - pose * point).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace hullslam
