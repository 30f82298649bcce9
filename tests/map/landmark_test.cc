// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/landmark.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

// The ratio of found to visible must be defined from the first frame on.
TEST(Landmark, CountsAsFoundInTheKeyframeThatMadeIt) {
  const Landmark landmark;
  EXPECT_EQ(landmark.visible, 1);
  EXPECT_EQ(landmark.found, 1);
}

TEST(Landmark, HasNoObservationsAtFirst) {
  const Landmark landmark;
  EXPECT_TRUE(landmark.position.isZero(0.0));
  EXPECT_EQ(landmark.observation_weight, 0);
  EXPECT_TRUE(landmark.observations.empty());
  EXPECT_FALSE(landmark.reference.IsValid());
  EXPECT_FALSE(landmark.created_by.IsValid());
  EXPECT_FALSE(Observation().keyframe.IsValid());
}

}  // namespace
}  // namespace hullslam
