// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/tracking_failure.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(TrackingFailure, NamesAreDifferent) {
  for (const TrackingFailure a : kTrackingFailures) {
    EXPECT_FALSE(ToString(a).empty());
    for (const TrackingFailure b : kTrackingFailures) {
      EXPECT_EQ(ToString(a) == ToString(b), a == b);
    }
  }
}

TEST(InitialisationFailure, NamesAreDifferent) {
  for (const InitialisationFailure a : kInitialisationFailures) {
    EXPECT_FALSE(ToString(a).empty());
    for (const InitialisationFailure b : kInitialisationFailures) {
      EXPECT_EQ(ToString(a) == ToString(b), a == b);
    }
  }
}

}  // namespace
}  // namespace hullslam
