// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/surfaces.h"

#include <gtest/gtest.h>

#include "scene/made_scene.h"

namespace hullslam {
namespace {

class SurfacesTest : public ::testing::Test {
 protected:
  void Add(const Eigen::Vector3d& base, double radius) {
    const auto id = ObjectId(static_cast<uint32_t>(bodies_.size()));
    bodies_.push_back(
        BodyOfEllipsoid(id, Standing("cup", base, Eigen::Vector3d::Constant(radius)).ellipsoid,
                        Eigen::Quaterniond::Identity()));
    for (const ObjectBody& other : bodies_) {
      observations_.joint[{id, other.id}].observations = 1;
      observations_.joint[{other.id, id}].observations = 1;
    }
  }
  std::vector<Surface> Find() const {
    std::vector<const ObjectBody*> standing;
    for (const ObjectBody& body : bodies_) {
      standing.push_back(&body);
    }
    return FindSurfaces(standing, FloorHeight(bodies_), observations_);
  }

  std::vector<ObjectBody> bodies_;
  ObservationStatistics observations_;
};

TEST_F(SurfacesTest, AreTheFloorAndATable) {
  Add({0.0, 0.0, 0.75}, 0.05);
  Add({0.2, 0.0, 0.76}, 0.05);
  Add({2.0, 0.0, 0.0}, 0.2);
  Add({-3.0, 0.0, 0.01}, 0.2);
  const std::vector<Surface> surfaces = Find();
  ASSERT_EQ(surfaces.size(), 2U);
  EXPECT_TRUE(surfaces[0].is_lowest);
  EXPECT_EQ(surfaces[0].objects, (std::vector<ObjectId>{ObjectId(2), ObjectId(3)}));
  EXPECT_FALSE(surfaces[1].is_lowest);
  EXPECT_NEAR(surfaces[1].height, 0.755, 0.006);
  EXPECT_EQ(surfaces[1].objects, (std::vector<ObjectId>{ObjectId(0), ObjectId(1)}));
}

TEST_F(SurfacesTest, TablesThatAreApartAreTwo) {
  Add({0.0, 0.0, 0.0}, 0.2);
  for (const double x : {0.0, 0.15, 3.0, 3.15}) {
    Add({x, 0.0, 0.75}, 0.05);
  }
  EXPECT_EQ(Find().size(), 3U);
}

TEST_F(SurfacesTest, AnObjectWhoseLowerSideWasCutOffReachesTheFloor) {
  Add({0.0, 0.0, 0.0}, 0.2);
  Add({1.0, 0.0, 0.01}, 0.2);
  Add({2.0, 0.0, 0.5}, 0.3);
  bodies_.back().is_bottom_seen = false;
  const std::vector<ObjectBody> extended = ExtendToFloor(bodies_);
  EXPECT_NEAR(extended[2].bottom, FloorHeight(bodies_), 1e-12);
  EXPECT_EQ(extended[0].bottom, bodies_[0].bottom);
  EXPECT_EQ(FloorHeight({}), 0.0);
}

TEST(HeightTolerance, GrowsWithTheSizesAndTheUncertainty) {
  ObjectBody a;
  a.size = 0.2;
  ObjectBody b;
  b.size = 0.4;
  EXPECT_NEAR(HeightTolerance(a, b), 0.09, 1e-12);
  b.height_sigma = 0.1;
  EXPECT_NEAR(HeightTolerance(a, b), 0.2, 1e-12);
}

TEST_F(SurfacesTest, NeighboursAreAtMostOneAndAHalfSumsOfTheirWidthsApart) {
  const auto surfaces = [&](double gap) {
    bodies_.clear();
    Add({5.0, 0.0, 0.0}, 0.2);
    Add({0.0, 0.0, 0.75}, 0.05);
    Add({0.1 + gap, 0.0, 0.75}, 0.05);
    return Find().size();
  };
  EXPECT_EQ(surfaces(0.29), 2U);
  EXPECT_EQ(surfaces(0.31), 1U) << "one thing above the floor is no surface";
}

TEST_F(SurfacesTest, OthersBetweenThemJoinDistantObjects) {
  Add({5.0, 0.0, 0.0}, 0.2);
  for (const double x : {0.0, 0.7, 0.35}) {
    Add({x, 0.0, 0.75}, 0.05);
  }
  const std::vector<Surface> surfaces = Find();
  ASSERT_EQ(surfaces.size(), 2U);
  EXPECT_EQ(surfaces[1].objects, (std::vector<ObjectId>{ObjectId(1), ObjectId(2), ObjectId(3)}));
}

TEST_F(SurfacesTest, ObjectsThatNoKeyframeHasSeenTogetherAreOnNoCommonSurface) {
  Add({5.0, 0.0, 0.0}, 0.2);
  Add({0.0, 0.0, 0.75}, 0.05);
  Add({0.2, 0.0, 0.75}, 0.05);
  ASSERT_EQ(Find().size(), 2U);
  observations_.joint.clear();
  EXPECT_EQ(Find().size(), 1U);
}

// The tolerance is 0.15 (0.4 + 0.4) = 0.12 m. At first the three lowest are on the floor, whose
// height is then 0.1; so all are, whose median is 0.11.
TEST_F(SurfacesTest, TheFloorIsTheMedianOfAllThatReachIt) {
  for (const double bottom : {0.0, 0.1, 0.11, 0.2, 0.21}) {
    Add({3.0 * bottom, 0.0, bottom}, 0.2);
  }
  EXPECT_NEAR(FloorHeight(bodies_), 0.11, 1e-9);
}

TEST_F(SurfacesTest, OnlyLowerSidesThatWereSeenTellTheFloor) {
  Add({0.0, 0.0, 0.0}, 0.2);
  Add({1.0, 0.0, -1.0}, 0.2);
  bodies_.back().is_bottom_seen = false;
  EXPECT_NEAR(FloorHeight(bodies_), 0.0, 1e-9);
  EXPECT_NEAR(ExtendToFloor(bodies_)[1].bottom, -1.0, 1e-9) << "it reaches down farther";
  bodies_.front().is_bottom_seen = false;
  EXPECT_NEAR(FloorHeight(bodies_), -1.0, 1e-9) << "there is nothing better";
}

}  // namespace
}  // namespace hullslam
