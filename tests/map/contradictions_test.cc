// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/contradictions.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(Contradictions, AreCountedSinceTheLastObservation) {
  Contradictions<LandmarkId> contradictions;
  EXPECT_EQ(contradictions.Add(LandmarkId(1), FrameId(7)), 1);
  EXPECT_EQ(contradictions.Add(LandmarkId(2), FrameId(9)), 1) << "of another landmark";
  EXPECT_EQ(contradictions.Add(LandmarkId(1), FrameId(7)), 2);
  EXPECT_EQ(contradictions.Add(LandmarkId(1), FrameId(8)), 1) << "it was observed again";
  EXPECT_EQ(contradictions.Add(LandmarkId(1), FrameId(3)), 2) << "its observers were culled";
  contradictions.Forget(LandmarkId(1));
  EXPECT_EQ(contradictions.Add(LandmarkId(1), FrameId(8)), 1);
}

}  // namespace
}  // namespace hullslam
