// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/landmark.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

// Ratios of found to visible are taken from the first frame on.
TEST(Landmark, HasBeenFoundOnceByTheKeyframeThatMadeIt) {
  const Landmark landmark;
  EXPECT_EQ(landmark.visible, 1);
  EXPECT_EQ(landmark.found, 1);
}

TEST(Landmark, HasNothingElseAtFirst) {
  const Landmark landmark;
  EXPECT_TRUE(landmark.position.isZero(0.0));
  EXPECT_EQ(landmark.support, 0);
  EXPECT_TRUE(landmark.observations.empty());
  EXPECT_FALSE(landmark.reference.IsValid());
  EXPECT_FALSE(landmark.created_by.IsValid());
  EXPECT_FALSE(Observation().keyframe.IsValid());
}

}  // namespace
}  // namespace hullslam
