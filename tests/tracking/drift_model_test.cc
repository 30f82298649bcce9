// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/drift_model.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cstdint>
#include <random>

#include "objects/object_index.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

PoseEstimate Seen(double squares) {
  PoseEstimate estimate;
  estimate.information = estimate.seen_information = 4.0 * Matrix6d::Identity();
  estimate.squares = squares;
  estimate.expected_squares = 3.0;
  return estimate;
}

TEST(DriftModel, ErrorsThatNeighboursShareWidenTheCovariance) {
  DriftModel model;
  EXPECT_NEAR(model.Measured(Seen(6.0))(0, 0), 0.5, 1e-12);
  EXPECT_NEAR(model.Measured(Seen(3.0))(0, 0), 0.375, 1e-12) << "the factor is that of both frames";
}

TEST(DriftModel, ErrorsBelowTheAssumedOnesDoNotNarrowIt) {
  DriftModel model;
  EXPECT_NEAR(model.Measured(Seen(1.0))(0, 0), 0.25, 1e-12);
}

// An exact motion leads from a frame that shows the same landmarks: however often it is fused, the
// error of the landmarks stays. An error of the motion is added with the weight of the prior.
TEST(DriftModel, AMotionTakesNothingFromTheErrorsOfLandmarks) {
  DriftModel model;
  PoseEstimate estimate = Seen(3.0);
  estimate.last_covariance = 0.25 * Matrix6d::Identity();
  for (const double motion : {1e-12, 0.04}) {
    estimate.motion_covariance = motion * Matrix6d::Identity();
    estimate.information = estimate.seen_information +
                           (0.01 * Matrix6d::Identity() + estimate.motion_covariance).inverse();
    const double weight = 1.0 - 4.0 / estimate.information(0, 0);
    const Matrix6d covariance = model.Measured(estimate);
    EXPECT_NEAR(covariance(0, 0), 0.25 + weight * weight * motion, 1e-9);
    EXPECT_NEAR(covariance(0, 1), 0.0, 1e-12);
  }
}

// Where the landmarks hardly determine the pose, the motion does, from the last frame.
TEST(DriftModel, AMotionBridgesWeakLandmarks) {
  DriftModel model;
  PoseEstimate estimate = Seen(3.0);
  estimate.seen_information = 1e-6 * Matrix6d::Identity();
  estimate.last_covariance = 0.25 * Matrix6d::Identity();
  estimate.motion_covariance = 0.04 * Matrix6d::Identity();
  estimate.information = estimate.seen_information + Matrix6d::Identity() / 0.29;
  EXPECT_NEAR(model.Measured(estimate)(0, 0), 0.29, 1e-3);
}

// The quotient of the squares and their mean if each keypoint is 0.5 px off to the left or right:
// one by one at random, or all of a quarter of the image together.
double SquaresOverExpected(bool quarters_share) {
  const SyntheticWorld world({.points = 300});
  const SyntheticMap made = MakeSyntheticMap(world, {0, 10});
  const SyntheticView view = world.Observe(5);
  Frame frame = *view.frame;
  PoseEstimate estimate;
  estimate.cam_from_world = SyntheticWorld::CamFromWorld(5);
  for (const uint32_t point : view.points) {
    estimate.landmarks.push_back(made.landmarks[point]);
  }
  std::mt19937 random(1);
  const PinholeCamera& camera = world.sensor().camera;
  for (Keypoint& keypoint : frame.features.keypoints) {
    const bool is_left = keypoint.undistorted.x() < static_cast<float>(camera.cx);
    const bool is_top = keypoint.undistorted.y() < static_cast<float>(camera.cy);
    const bool to_left = quarters_share ? is_left == is_top : random() % 2 == 0;
    keypoint.undistorted.x() += to_left ? -0.5F : 0.5F;
  }
  const TrackingOptions options;
  const ObjectOptions objects;
  const ObjectIndex index(made.map, camera);
  estimate = RefinePose(frame, made.map, {world.sensor(), options, objects, index}, {}, estimate);
  EXPECT_GT(estimate.inliers, 60);
  EXPECT_EQ(estimate.seen_information, estimate.information);
  return estimate.squares / estimate.expected_squares;
}

TEST(RefinePose, ErrorsThatAQuarterSharesCountMore) {
  EXPECT_LT(SquaresOverExpected(false), 1.0);
  EXPECT_GT(SquaresOverExpected(true), 3.0);
}

}  // namespace
}  // namespace hullslam
