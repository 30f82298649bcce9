// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/sources/pair_votes.h"

#include <gtest/gtest.h>

#include <numbers>

#include "support/synthetic_world.h"

namespace hullslam {
namespace {

TEST(MakePixelPairs, EachMatchGivesItsPixelsAndTheScaleOfTheirLevels) {
  FrameFeatures a;
  FrameFeatures b;
  for (FrameFeatures* const features : {&a, &b}) {
    features->keypoints.resize(3);
  }
  a.keypoints[2].undistorted = {10.0f, 20.0f};
  a.keypoints[2].level = 0;
  b.keypoints[1].undistorted = {30.0f, 40.0f};
  b.keypoints[1].level = 2;
  const std::vector<Match> matches = {{.query = 2, .keypoint = 1}};
  const std::vector<PixelPair> pairs = MakePixelPairs(a, b, matches, ScaleLevels::Create(3, 1.2));
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].a, Eigen::Vector2d(10.0, 20.0));
  EXPECT_EQ(pairs[0].b, Eigen::Vector2d(30.0, 40.0));
  EXPECT_EQ(pairs[0].sigma_a, 1.0);
  EXPECT_NEAR(pairs[0].sigma_b, 1.44, 1e-6);
}

// A map of four keyframes that are 0.4 m apart, and a frame between them.
class PairVotesTest : public testing::Test {
 protected:
  // The votes on a pose that is turned from the true one by so many degrees.
  PairVotes Vote(const Frame& frame, double degrees) const {
    LocalTracking tracking;
    tracking.reference = KeyframeId(1);
    tracking.estimate.cam_from_world =
        Rigid3(ExpSo3({0.0, degrees * std::numbers::pi / 180.0, 0.0}), Eigen::Vector3d::Zero()) *
        SyntheticWorld::CamFromWorld(30);
    return VoteByPairs(frame, made_.map, {world_.sensor(), options_, objects_, index_}, tracking);
  }

  const SyntheticWorld world_{{.pixel_noise = 0.3}};
  const SyntheticMap made_ = MakeSyntheticMap(world_, {0, 20, 40, 60});
  const TrackingOptions options_;
  const ObjectOptions objects_;
  const ObjectIndex index_;
};

TEST_F(PairVotesTest, PairsAgreeWithTheRightPoseAndNotWithATurnedOne) {
  const SyntheticView view = world_.Observe(30);
  const PairVotes right = Vote(*view.frame, 0.0);
  EXPECT_GE(right.agree, 3);
  EXPECT_EQ(right.contradict, 0);
  const PairVotes turned = Vote(*view.frame, 3.0);
  EXPECT_EQ(turned.agree, 0);
  EXPECT_EQ(turned.contradict, right.agree);
}

TEST_F(PairVotesTest, ImagesOfOtherPlacesDoNotVote) {
  const SyntheticView elsewhere = SyntheticWorld({.seed = 2}).Observe(30);
  const PairVotes votes = Vote(*elsewhere.frame, 0.0);
  EXPECT_EQ(votes.agree, 0);
  EXPECT_EQ(votes.contradict, 0);
}

}  // namespace

}  // namespace hullslam
