// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/sighting_counter.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(SightingCounter, IsEmptyAtFirst) { EXPECT_TRUE(SightingCounter().Take().empty()); }

TEST(SightingCounter, CountsPerLandmarkInOrderOfId) {
  SightingCounter counter;
  counter.CountVisible(LandmarkId(900));
  counter.CountVisible(LandmarkId(3));
  counter.CountVisible(LandmarkId(900));
  counter.CountFound(LandmarkId(900));
  counter.CountFound(LandmarkId(7));
  const std::vector<Sighting> sightings = counter.Take();
  ASSERT_EQ(sightings.size(), 3u);
  EXPECT_EQ(sightings[0].landmark, LandmarkId(3));
  EXPECT_EQ(sightings[0].visible, 1);
  EXPECT_EQ(sightings[0].found, 0);
  EXPECT_EQ(sightings[1].landmark, LandmarkId(7));
  EXPECT_EQ(sightings[1].visible, 0);
  EXPECT_EQ(sightings[1].found, 1);
  EXPECT_EQ(sightings[2].landmark, LandmarkId(900));
  EXPECT_EQ(sightings[2].visible, 2);
  EXPECT_EQ(sightings[2].found, 1);
}

TEST(SightingCounter, StartsAgainFromZeroAfterTake) {
  SightingCounter counter;
  counter.CountVisible(LandmarkId(5));
  counter.CountVisible(LandmarkId(1));
  counter.Take();
  EXPECT_TRUE(counter.Take().empty());
  counter.CountFound(LandmarkId(5));
  const std::vector<Sighting> sightings = counter.Take();
  ASSERT_EQ(sightings.size(), 1u);
  EXPECT_EQ(sightings[0].landmark, LandmarkId(5));
  EXPECT_EQ(sightings[0].visible, 0) << "what was taken is not counted again";
  EXPECT_EQ(sightings[0].found, 1);
}

}  // namespace
}  // namespace hullslam
