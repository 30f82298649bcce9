// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/object_sighting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "objects/made_objects.h"

namespace hullslam {
namespace {

const Eigen::Vector3d kBook(0.15, 0.10, 0.04);

class ObjectSightingTest : public ::testing::Test {
 protected:
  // The book, turned about two axes.
  static MadeObject Book(double turn) {
    MadeObject book = MakeObject("book", Eigen::Vector3d::Zero(), kBook);
    book.ellipsoid.world_from_object.rotation =
        ExpSo3({0.0, 0.0, turn}) * ExpSo3({0.7 * turn, 0.0, 0.0});
    return book;
  }
  // Depth points at every pixel of a grid, as a depth image gives them. (Those of Detect() are
  // even on the surface.)
  std::vector<Eigen::Vector3d> DepthPoints(const Ellipsoid& in_cam) const {
    std::vector<Eigen::Vector3d> points;
    const Rigid3 object_from_cam = Inverse(in_cam.world_from_object);
    for (double v = 0.0; v < 480.0; v += 2.0) {
      for (double u = 0.0; u < 640.0; u += 2.0) {
        const Eigen::Vector3d ray = sensor_.camera.Unproject({u, v}, 1.0);
        const Eigen::Vector3d d = (object_from_cam.rotation * ray).cwiseQuotient(in_cam.half_axes);
        const Eigen::Vector3d o = object_from_cam.translation.cwiseQuotient(in_cam.half_axes);
        const double root = std::pow(o.dot(d), 2) - d.squaredNorm() * (o.squaredNorm() - 1.0);
        if (root >= 0.0) {
          points.push_back((-o.dot(d) - std::sqrt(root)) / d.squaredNorm() * ray);
        }
      }
    }
    return points;
  }
  Sensor sensor_ = MakeObjectSensor();
};

// The distance is right for every rotation of the object, which the sighting does not know.
TEST_F(ObjectSightingTest, TellsWhereTheCenterIsAndHowLargeTheObject) {
  for (const double turn : {0.0, 0.4, 0.9, 1.5, 2.2}) {
    const MadeObject book = Book(turn);
    const Rigid3 pose = CameraOnCircle(0.3, 2.0, 0.9);
    Detection detection = Detect(book, sensor_, pose);
    detection.points = DepthPoints(pose * book.ellipsoid);
    const auto sighting = SightObject(sensor_.camera, detection);
    ASSERT_TRUE(sighting);
    const double distance = DistanceOfCenter(*sighting, kBook);
    // The formula assumes parallel rays. They are not quite parallel, which gives an error of 6 mm
    // at 2.2 m.
    EXPECT_NEAR(distance, pose.translation.norm(), 0.01) << turn;
    EXPECT_LT((distance * sighting->ray - pose.translation).norm(), 0.01) << turn;
    EXPECT_TRUE(MayHaveSize(*sighting, distance, kBook));
    EXPECT_FALSE(MayHaveSize(*sighting, distance, 2.5 * kBook));
    EXPECT_FALSE(MayHaveSize(*sighting, distance, 0.4 * kBook));
    EXPECT_GE(sighting->half_axes[0], sighting->half_axes[1]);
  }
}

TEST_F(ObjectSightingTest, SizesAreBetweenTheHalfAxes) {
  const ObjectSighting sighting{.ray = Eigen::Vector3d::UnitZ(), .half_axes = {0.1, 0.02}};
  EXPECT_TRUE(MayHaveSize(sighting, 1.0, {0.02, 0.1, 0.1}));
  EXPECT_TRUE(MayHaveSize(sighting, 1.0, {0.1, 0.02, 0.02}));
  EXPECT_FALSE(MayHaveSize(sighting, 1.0, {0.1, 0.1, 0.1}));     // a ball is not flat
  EXPECT_FALSE(MayHaveSize(sighting, 1.0, {0.02, 0.02, 0.02}));  // nor 0.1 m long
}

TEST_F(ObjectSightingTest, NeedsAWholeMaskButNoDepth) {
  Detection detection = Detect(Book(0.4), sensor_, CameraOnCircle(0.3, 2.0, 0.9));
  detection.points.clear();
  const auto without_depth = SightObject(sensor_.camera, detection);
  ASSERT_TRUE(without_depth);
  EXPECT_EQ(without_depth->surface, 0.0);
  Detection cut = detection;
  cut.is_cut = true;
  EXPECT_FALSE(SightObject(sensor_.camera, cut));
  Detection flat = detection;
  flat.hull.resize(2);
  EXPECT_FALSE(SightObject(sensor_.camera, flat));
}

TEST_F(ObjectSightingTest, AFairShareOfVotesIsEnoughForAClass) {
  ObjectLandmark object;
  EXPECT_FALSE(MayHaveClass(object, "cup"));
  object.votes = {{"cup", 3.0}, {"vase", 6.0}, {"bowl", 1.0}};
  EXPECT_TRUE(MayHaveClass(object, "cup"));
  EXPECT_TRUE(MayHaveClass(object, "vase"));
  EXPECT_FALSE(MayHaveClass(object, "bowl"));
  EXPECT_FALSE(MayHaveClass(object, "chair"));
}

TEST_F(ObjectSightingTest, SizesMayBeOffByAFactorOfOneAndAHalf) {
  const ObjectSighting sighting{.ray = Eigen::Vector3d::UnitZ(), .half_axes = {0.1, 0.02}};
  const Eigen::Vector3d disc(0.02, 0.1, 0.1);
  EXPECT_TRUE(MayHaveSize(sighting, 1.49, disc));
  EXPECT_FALSE(MayHaveSize(sighting, 1.51, disc));
  EXPECT_TRUE(MayHaveSize(sighting, 1.01 / 1.5, disc));
  EXPECT_FALSE(MayHaveSize(sighting, 0.99 / 1.5, disc));
}

TEST_F(ObjectSightingTest, AQuarterOfTheVotesIsAFairShare) {
  ObjectLandmark object;
  object.votes = {{"cup", 1.0}, {"vase", 3.0}};
  EXPECT_TRUE(MayHaveClass(object, "cup"));
  object.votes["vase"] = 3.1;
  EXPECT_FALSE(MayHaveClass(object, "cup"));
}

}  // namespace
}  // namespace hullslam
