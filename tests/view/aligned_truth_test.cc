// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/aligned_truth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/made_view.h"

namespace hullslam {
namespace {

// A path that determines the alignment.
Trajectory Spiral() {
  Trajectory poses;
  for (int i = 0; i < 40; ++i) {
    const double angle = 0.2 * i;
    poses.push_back({10.0 + 0.1 * i, Rigid3(ExpSo3({0.0, angle, 0.0}),
                                            {std::cos(angle), 0.02 * i, std::sin(angle)})});
  }
  return poses;
}

TEST(AlignedTruth, LiesOnTheEstimateWhateverItsWorldIs) {
  ViewModel model;
  model.trajectory = Spiral();
  const Rigid3 truth_from_map(ExpSo3({0.4, -0.3, 1.0}), {5.0, -2.0, 1.0});
  Trajectory truth = model.trajectory;
  for (StampedPose& pose : truth) {
    pose.world_from_cam.translation *= 2.5;  // the unit of the map has 2.5 m
    pose.world_from_cam = truth_from_map * pose.world_from_cam;
  }
  EXPECT_EQ(AddGroundtruth(truth, AlignmentKind::kSim3, model), "");
  ASSERT_EQ(model.groundtruth.size(), truth.size());
  ASSERT_EQ(model.errors.metres.size(), truth.size());
  for (size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LT((model.groundtruth[i].world_from_cam.translation -
               model.trajectory[i].world_from_cam.translation)
                  .norm(),
              1e-9);
    EXPECT_LT(model.errors.metres[i], 1e-9);
  }
}

TEST(AlignedTruth, TwoPosesCannotBeAligned) {
  ViewModel model;
  model.trajectory = {Spiral()[0], Spiral()[1]};
  EXPECT_NE(AddGroundtruth(Spiral(), AlignmentKind::kSe3, model), "");
  EXPECT_TRUE(model.groundtruth.empty());
  EXPECT_TRUE(model.errors.metres.empty());
}

TEST(AddUp, IsThatOfTheTruthOrOfTheImages) {
  // The camera looks down by 20 degrees, and the true world has z up.
  const Rigid3 tilted(ExpSo3({-20.0 / 57.3, 0.0, 0.0}), Eigen::Vector3d::Zero());
  ViewModel model;
  model.trajectory = {{0.0, tilted}, {1.0, tilted}};
  AddUp(std::nullopt, model);
  ASSERT_TRUE(model.up);
  EXPECT_LT((*model.up + tilted.rotation * Eigen::Vector3d::UnitY()).norm(), 1e-9);
  const Rigid3 truth_from_map(ExpSo3({-M_PI / 2.0, 0.0, 0.0}), Eigen::Vector3d::Zero());
  Trajectory truth = model.trajectory;
  for (StampedPose& pose : truth) {
    pose.world_from_cam = truth_from_map * pose.world_from_cam;
  }
  AddUp(truth, model);
  ASSERT_TRUE(model.up);
  EXPECT_LT((*model.up + Eigen::Vector3d::UnitY()).norm(), 1e-9) << model.up->transpose();
}

}  // namespace
}  // namespace hullslam
