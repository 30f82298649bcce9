// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/sources/pair_votes.h"

#include <gtest/gtest.h>

#include <numbers>

#include "support/synthetic_world.h"

namespace hullslam {
namespace {

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
