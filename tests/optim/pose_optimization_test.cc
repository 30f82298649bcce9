// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/pose_optimization.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <optional>
#include <random>
#include <vector>

#include "camera/point_measurement.h"
#include "support/pose_distance.h"
#include "support/random_geometry.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

const PinholeCamera kCamera = SyntheticSensor().camera;

class PoseOptimization : public ::testing::Test {
 protected:
  // `count` exact observations of random points in view of `true_pose_`.
  std::vector<PoseObservation> Observe(int count, bool has_depth) {
    std::vector<PoseObservation> observations;
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d in_cam =
          random_.Vector(1.0).cwiseProduct(Eigen::Vector3d(1.2, 0.9, 2.0)) +
          Eigen::Vector3d(0.0, 0.0, 4.0);
      PoseObservation& observation = observations.emplace_back();
      observation.point = Inverse(true_pose_) * in_cam;
      const Eigen::Vector3d measured = ProjectRgbd(kCamera, in_cam);
      observation.measurement = PointMeasurement::Create(
          measured.head<2>(), 1.0, has_depth ? std::optional(measured.z()) : std::nullopt,
          {.pixel_sigma = 1.0});
    }
    return observations;
  }
  Rigid3 Start() { return random_.Pose(0.02, 0.05) * true_pose_; }

  RandomGeometry random_{1};
  const Rigid3 true_pose_ = random_.Pose(1.0, 2.0);
};

TEST_F(PoseOptimization, RecoversTheTruePoseWithDepth) {
  for (int i = 0; i < 10; ++i) {
    const auto observations = Observe(100, true);
    const PoseOptimizationResult result = OptimizePose(kCamera, Start(), observations);
    EXPECT_LT(Distance(result.cam_from_world, true_pose_), 1e-9);
    EXPECT_EQ(result.inlier_count, 100);
    EXPECT_EQ(result.is_inlier, std::vector<uint8_t>(100, 1));
  }
}

TEST_F(PoseOptimization, RecoversTheTruePoseWithoutDepth) {
  for (int i = 0; i < 10; ++i) {
    const auto observations = Observe(100, false);
    const PoseOptimizationResult result = OptimizePose(kCamera, Start(), observations);
    EXPECT_LT(Distance(result.cam_from_world, true_pose_), 1e-9);
    EXPECT_EQ(result.inlier_count, 100);
  }
}

TEST_F(PoseOptimization, NeedsNoMoreThanThreePointsWithDepth) {
  const auto observations = Observe(3, true);
  const PoseOptimizationResult result = OptimizePose(kCamera, Start(), observations);
  EXPECT_LT(Distance(result.cam_from_world, true_pose_), 1e-7);
  EXPECT_EQ(result.inlier_count, 3);
}

TEST_F(PoseOptimization, FlagsThirtyPercentOfOutliers) {
  for (const bool has_depth : {true, false}) {
    auto observations = Observe(100, has_depth);
    for (size_t i = 0; i < 30; ++i) {
      const double side = i % 2 == 0 ? 1.0 : -1.0;
      observations[3 * i].measurement.measured +=
          side * Eigen::Vector3d(random_.Number(20, 100), random_.Number(-100, 100), 0.0);
    }
    const PoseOptimizationResult result = OptimizePose(kCamera, Start(), observations);
    EXPECT_LT(Distance(result.cam_from_world, true_pose_), 1e-7);
    EXPECT_EQ(result.inlier_count, 70);
    for (size_t i = 0; i < observations.size(); ++i) {
      EXPECT_EQ(result.is_inlier[i], i % 3 == 0 && i < 90 ? 0 : 1) << i;
    }
  }
}

// All outliers are on one side, so squared errors would move the pose until no observation fits.
TEST_F(PoseOptimization, TheFirstRoundsAreRobust) {
  auto observations = Observe(100, true);
  for (size_t i = 0; i < 30; ++i) {
    observations[3 * i].measurement.measured += Eigen::Vector3d(random_.Number(40, 60), 0.0, 0.0);
  }
  const Rigid3 start = Start();
  EXPECT_LT(Distance(OptimizePose(kCamera, start, observations).cam_from_world, true_pose_), 1e-7);
  const PoseOptimizationResult plain =
      OptimizePose(kCamera, start, observations, {.robust_rounds = 0});
  EXPECT_GT(Distance(plain.cam_from_world, true_pose_), 1e-3);
}

TEST_F(PoseOptimization, AWrongDepthAloneMakesAnOutlier) {
  auto observations = Observe(50, true);
  observations[7].measurement.measured.z() -= 10.0;
  observations[8].measurement.measured.z() -= 10.0;
  observations[8].measurement.inverse_sigma.z() = 0.0;  // an infinite sigma: it is ignored
  const PoseOptimizationResult result = OptimizePose(kCamera, Start(), observations);
  EXPECT_EQ(result.inlier_count, 49);
  EXPECT_EQ(result.is_inlier[7], 0);
}

// Bundle adjustment and mapping, which use the same error, would choose the same inliers.
TEST_F(PoseOptimization, InliersAreThoseOfTheErrorOfPoints) {
  auto observations = Observe(200, true);
  for (PoseObservation& observation : observations) {
    observation.measurement.measured += 2.0 * random_.Vector(1.0);
  }
  const PoseOptimizationResult result = OptimizePose(kCamera, Start(), observations);
  EXPECT_LT(result.inlier_count, 200);
  EXPECT_GT(result.inlier_count, 50);
  for (size_t i = 0; i < observations.size(); ++i) {
    const Eigen::Vector3d in_cam = result.cam_from_world * observations[i].point;
    EXPECT_EQ(result.is_inlier[i] != 0, IsInlier(kCamera, observations[i].measurement, in_cam));
  }
}

TEST_F(PoseOptimization, ErrorsAreMeasuredInSigmas) {
  auto observations = Observe(100, false);
  observations[4].measurement.measured.x() += 4.0;
  observations[5].measurement.measured.x() += 4.0;
  observations[5].measurement.inverse_sigma *= 0.5;
  const PoseOptimizationResult result = OptimizePose(kCamera, true_pose_, observations);
  EXPECT_EQ(result.is_inlier[4], 0);
  EXPECT_EQ(result.is_inlier[5], 1);
}

TEST_F(PoseOptimization, TheErrorIsAsLargeAsTheNoiseExplains) {
  auto observations = Observe(200, true);
  std::mt19937 generator(2);
  std::normal_distribution<double> noise;
  for (PoseObservation& observation : observations) {
    observation.measurement.measured +=
        Eigen::Vector3d(noise(generator), noise(generator), 0.3 * noise(generator));
  }
  const PoseOptimizationResult result = OptimizePose(kCamera, Start(), observations);
  // About sigma / focal length / sqrt(points) times the depth.
  EXPECT_LT(Distance(result.cam_from_world, true_pose_), 0.005);
  EXPECT_GT(Distance(result.cam_from_world, true_pose_), 1e-6);
  EXPECT_GT(result.inlier_count, 175);  // 95 % are expected
  EXPECT_EQ(result.inlier_count,
            std::accumulate(result.is_inlier.begin(), result.is_inlier.end(), 0));
}

TEST_F(PoseOptimization, DoesNotDependOnTheWorldFrame) {
  const auto observations = Observe(60, true);
  const Rigid3 start = Start();
  const Rigid3 new_from_old = random_.Pose(2.0, 5.0);
  auto moved = observations;
  for (PoseObservation& observation : moved) {
    observation.point = new_from_old * observation.point;
  }
  const Rigid3 expected = OptimizePose(kCamera, start, observations).cam_from_world;
  const Rigid3 found =
      OptimizePose(kCamera, start * Inverse(new_from_old), moved).cam_from_world * new_from_old;
  EXPECT_LT(Distance(found, expected), 1e-9);
}

TEST_F(PoseOptimization, ReturnsTheStartForFewerThanThreePoints) {
  const Rigid3 start = Start();
  for (const int count : {0, 1, 2}) {
    const auto observations = Observe(count, true);
    const PoseOptimizationResult result = OptimizePose(kCamera, start, observations);
    EXPECT_EQ(Distance(result.cam_from_world, start), 0.0);
    EXPECT_LT(result.inlier_count, 3);
    EXPECT_EQ(result.is_inlier.size(), static_cast<size_t>(count));
  }
}

// This also holds if only the last round finds too few inliers.
TEST_F(PoseOptimization, ReturnsTheStartForFewerThanThreeInliers) {
  auto observations = Observe(8, true);
  for (PoseObservation& observation : observations) {
    observation.measurement.measured = {random_.Number(0, 640), random_.Number(0, 480),
                                        random_.Number(0, 640)};
  }
  const Rigid3 start = Start();
  for (const int rounds : {1, 2, 4}) {
    const PoseOptimizationResult result =
        OptimizePose(kCamera, start, observations, {.rounds = rounds});
    ASSERT_LT(result.inlier_count, 3);
    EXPECT_EQ(Distance(result.cam_from_world, start), 0.0) << rounds;
  }
}

// The landmark of a wrong match may be behind the camera, where its error cannot be minimised.
TEST_F(PoseOptimization, APointBehindTheCameraDoesNotStopTheOthers) {
  auto observations = Observe(50, true);
  observations[20].point = Inverse(true_pose_) * Eigen::Vector3d(0.1, 0.1, -2.0);
  // So far from the truth that no observation is an inlier at the start.
  const Rigid3 start = Rigid3(ExpSo3({0.03, -0.04, 0.02}), {0.05, 0.05, -0.05}) * true_pose_;
  const PoseOptimizationResult result = OptimizePose(kCamera, start, observations);
  EXPECT_LT(Distance(result.cam_from_world, true_pose_), 1e-7);
  EXPECT_EQ(result.inlier_count, 49);
  EXPECT_EQ(result.is_inlier[20], 0);
}

TEST_F(PoseOptimization, SameInputGivesTheSameBits) {
  const auto observations = Observe(100, false);
  const Rigid3 start = Start();
  const Rigid3 first = OptimizePose(kCamera, start, observations).cam_from_world;
  const Rigid3 second = OptimizePose(kCamera, start, observations).cam_from_world;
  EXPECT_EQ(first.rotation.coeffs(), second.rotation.coeffs());
  EXPECT_EQ(first.translation, second.translation);
}

}  // namespace
}  // namespace hullslam
