// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/messages.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

// What nobody filled in must not pass for a pose.
TEST(TrackedFrame, IsNotTrackedAtFirst) {
  const TrackedFrame frame;
  EXPECT_EQ(frame.state, TrackingState::kNotInitialized);
  EXPECT_FALSE(frame.frame.IsValid());
  EXPECT_FALSE(frame.reference.IsValid());
  EXPECT_EQ(frame.inliers, 0);
}

TEST(KeyframeRequest, IsThatOfTheFirstKeyframeAtFirst) {
  const KeyframeRequest request;
  EXPECT_FALSE(request.reference.IsValid());
  EXPECT_EQ(request.cam_from_reference * Eigen::Vector3d(1.0, 2.0, 3.0),
            Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_TRUE(request.landmarks.empty());
  EXPECT_TRUE(request.sightings.empty());
}

TEST(Sighting, CountsNothingAtFirst) {
  const Sighting sighting;
  EXPECT_FALSE(sighting.landmark.IsValid());
  EXPECT_EQ(sighting.visible, 0);
  EXPECT_EQ(sighting.found, 0);
}

}  // namespace
}  // namespace hullslam
