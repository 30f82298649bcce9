// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/join_requests.h"

#include <gtest/gtest.h>

#include <numbers>

#include "support/synthetic_world.h"

namespace hullslam {
namespace {

// A camera in a map of two keyframes, whose poses are true.
class JoinRequestsTest : public testing::Test {
 protected:
  PoseEstimate At(const Rigid3& cam_from_world) const {
    PoseEstimate estimate;
    estimate.cam_from_world = cam_from_world;
    for (const uint32_t point : world_.Observe(FrameId(99), cam_from_world).points) {
      estimate.landmarks.push_back(made_.landmarks[point]);
    }
    return estimate;
  }
  static Rigid3 Turned(double degrees) {
    return {ExpSo3({0.0, degrees * std::numbers::pi / 180.0, 0.0}), Eigen::Vector3d::Zero()};
  }
  static Rigid3 Moved(double metres) {
    return {Eigen::Quaterniond::Identity(), {metres, 0.0, 0.0}};
  }
  bool MayAskAgain(const PoseEstimate& estimate) {
    return requests_.MayAskAgain(made_.map, world_.sensor(), KeyframeId(0), estimate);
  }
  // Asks as often as it may; returns how often, at most 100 times.
  int AskAt(const Rigid3& cam_from_world) {
    const PoseEstimate estimate = At(cam_from_world);
    int count = 0;
    while (count < 100 && MayAskAgain(estimate)) {
      requests_.Add(made_.map, KeyframeId(0), estimate);
      ++count;
    }
    return count;
  }

  const SyntheticWorld world_{{.points = 800}};
  SyntheticMap made_ = MakeSyntheticMap(world_, {0, 5});
  JoinRequests requests_;
};

TEST_F(JoinRequestsTest, AreFewInOneView) {
  EXPECT_EQ(AskAt(Rigid3()), 4);
  EXPECT_EQ(AskAt(Rigid3()), 0);
  EXPECT_EQ(AskAt(Turned(1.0)), 0);
  EXPECT_EQ(AskAt(Moved(0.1)), 0);
}

TEST_F(JoinRequestsTest, BeginAgainInEachNewView) {
  AskAt(Rigid3());
  EXPECT_EQ(AskAt(Turned(12.0)), 4) << "another part of the scene";
  EXPECT_EQ(AskAt(Moved(0.9)), 4) << "the same part from another direction";
  EXPECT_EQ(AskAt(Rigid3()), 4);
}

// A slow camera comes to another view, too.
TEST_F(JoinRequestsTest, AreOfTheFirstFrameOfTheView) {
  int count = 0;
  for (double degrees = 0.0; degrees <= 24.0; degrees += 0.5) {
    count += AskAt(Turned(degrees));
  }
  EXPECT_GE(count, 8);
  EXPECT_LE(count, 24);
}

TEST_F(JoinRequestsTest, OfAnotherIslandDoNotCount) {
  AskAt(Rigid3());
  const KeyframeId other = made_.map.AddKeyframe(world_.Observe(FrameId(50), Rigid3()).frame,
                                                 Rigid3(), made_.map.BeginIsland());
  const PoseEstimate estimate = At(Rigid3());
  EXPECT_TRUE(requests_.MayAskAgain(made_.map, world_.sensor(), other, estimate));
}

}  // namespace
}  // namespace hullslam
