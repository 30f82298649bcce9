// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/object_groundtruth.h"

#include <gtest/gtest.h>

#include <numbers>

#include "hullslam/util/check.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

TEST(TrueObject, SizeIsTheMeanFullExtentForAnyPose) {
  TrueObject object;
  object.half_extents = {0.1, 0.2, 0.6};
  EXPECT_NEAR(object.Size(), 0.6, 1e-15);
  object.world_from_object = Rigid3(ExpSo3({1.0, 2.0, 3.0}), {4.0, 5.0, 6.0});
  EXPECT_NEAR(object.Size(), 0.6, 1e-15);
}

TrueObject MakeTruth(const Eigen::Vector3d& center, const std::string& label = "cup") {
  TrueObject truth;
  truth.label = label;
  truth.world_from_object = Rigid3(ExpSo3({0.2, 0.1, 0.5}), center);
  truth.half_extents = {0.1, 0.2, 0.3};  // size 0.4
  return truth;
}

ObjectResult MakeObject(uint32_t id, const Ellipsoid& ellipsoid) {
  ObjectResult object;
  object.id = ObjectId(id);
  object.state = ObjectState::kMapped;
  object.ellipsoid = ellipsoid;
  return object;
}

// The ellipsoid of a true object that was mapped without error, moved by `shift` in the world.
Ellipsoid MappedAs(const TrueObject& truth, const Eigen::Vector3d& shift = {0, 0, 0}) {
  Ellipsoid ellipsoid = {truth.world_from_object, truth.half_extents};
  ellipsoid.world_from_object.translation += shift;
  return ellipsoid;
}

TEST(ObjectGroundtruth, APerfectlyMappedObjectHasNoErrorInAnyWorldFrame) {
  RandomGeometry random(5);
  const std::vector<TrueObject> truths = {MakeTruth({0, 0, 0}), MakeTruth({1, 0, 0})};
  const Rigid3 truth_from_map = random.Pose(2.0, 10.0);
  ObjectResults report;
  report.objects = {MakeObject(4, Inverse(truth_from_map) * MappedAs(truths[1]))};
  const GroundtruthComparison comparison = CompareWithTruth(truths, report, Sim3(truth_from_map));
  ASSERT_EQ(comparison.errors.size(), 1U);
  const ObjectError& error = comparison.errors[0];
  EXPECT_EQ(error.object, ObjectId(4));
  EXPECT_EQ(error.truth, 1U);
  EXPECT_LT(error.center_m, 1e-12);
  EXPECT_LT((error.axis_ratios - Eigen::Vector3d::Ones()).norm(), 1e-12);
  EXPECT_LT((error.extent_ratios - Eigen::Vector3d::Ones()).norm(), 1e-9);
  EXPECT_EQ(comparison.times_mapped, (std::vector<size_t>{0, 1}));
  EXPECT_TRUE(comparison.without_truth.empty());
}

// The map of a monocular run has a unit of length of its own.
TEST(ObjectGroundtruth, ErrorsAreInMetresInAMapOfAnyUnit) {
  RandomGeometry random(6);
  const std::vector<TrueObject> truths = {MakeTruth({0, 0, 0}), MakeTruth({1, 0, 0})};
  const Rigid3 pose = random.Pose(2.0, 10.0);
  const Sim3 truth_from_map(2.5, pose.rotation, pose.translation);
  Ellipsoid mapped = MappedAs(truths[1], {0.0, 0.02, 0.0});
  mapped.half_axes = {0.11, 0.2, 0.27};
  ObjectResults report;
  report.objects = {MakeObject(4, Inverse(truth_from_map) * mapped)};
  const ObjectError error = CompareWithTruth(truths, report, truth_from_map).errors.at(0);
  EXPECT_EQ(error.truth, 1U);
  EXPECT_NEAR(error.center_m, 0.02, 1e-12);
  EXPECT_NEAR(error.center_share, 0.05, 1e-12);
  EXPECT_LT((error.axis_ratios - Eigen::Vector3d(0.9, 1.0, 1.1)).norm(), 1e-12);
  EXPECT_LT((error.extent_ratios - Eigen::Vector3d(1.1, 1.0, 0.9)).norm(), 1e-9);
}

TEST(ObjectGroundtruth, ErrorsMatchHandComputedValues) {
  const std::vector<TrueObject> truths = {MakeTruth({0, 0, 0})};
  ObjectResults report;
  Ellipsoid mapped = MappedAs(truths[0], {0.0, 0.02, 0.0});
  mapped.half_axes = {0.11, 0.2, 0.27};
  report.objects = {MakeObject(0, mapped)};
  const ObjectError error = CompareWithTruth(truths, report, {}).errors.at(0);
  EXPECT_NEAR(error.center_m, 0.02, 1e-12);
  EXPECT_NEAR(error.center_share, 0.05, 1e-12);
  EXPECT_LT((error.axis_ratios - Eigen::Vector3d(0.9, 1.0, 1.1)).norm(), 1e-12);
  EXPECT_LT((error.extent_ratios - Eigen::Vector3d(1.1, 1.0, 0.9)).norm(), 1e-9);
}

// Permuting the axes gives the same ellipsoid. A rotation by a right angle gives another ellipsoid
// with axes of the same lengths.
TEST(ObjectGroundtruth, TheOrderOfTheAxesDoesNotMatterButTheirDirectionsDo) {
  const std::vector<TrueObject> truths = {MakeTruth({0, 0, 0})};
  ObjectResults report;
  Ellipsoid mapped = MappedAs(truths[0]);
  const double quarter = 0.5 * std::numbers::pi;
  const Rigid3 turn(ExpSo3({0.0, 0.0, quarter}), Eigen::Vector3d::Zero());
  mapped.world_from_object = mapped.world_from_object * turn;
  std::swap(mapped.half_axes.x(), mapped.half_axes.y());
  report.objects = {MakeObject(0, mapped)};
  ObjectError error = CompareWithTruth(truths, report, {}).errors.at(0);
  EXPECT_LT((error.axis_ratios - Eigen::Vector3d::Ones()).norm(), 1e-12);
  EXPECT_LT((error.extent_ratios - Eigen::Vector3d::Ones()).norm(), 1e-9);
  std::swap(report.objects[0].ellipsoid.half_axes.x(), report.objects[0].ellipsoid.half_axes.y());
  error = CompareWithTruth(truths, report, {}).errors.at(0);
  EXPECT_LT((error.axis_ratios - Eigen::Vector3d::Ones()).norm(), 1e-12);
  EXPECT_LT((error.extent_ratios - Eigen::Vector3d(2.0, 0.5, 1.0)).norm(), 1e-9);
}

TEST(ObjectGroundtruth, CountsObjectsMappedTwiceMissedAndInvented) {
  TrueObject walker = MakeTruth({3, 0, 0}, "person");
  walker.is_dynamic = true;
  const std::vector<TrueObject> truths = {MakeTruth({0, 0, 0}), MakeTruth({1, 0, 0}), walker};
  ObjectResults report;
  report.objects = {
      MakeObject(0, MappedAs(truths[0], {0.1, 0.0, 0.0})),   // farther
      MakeObject(1, MappedAs(truths[0], {0.0, 0.05, 0.0})),  // nearer
      MakeObject(2, MappedAs(truths[0], {0.0, 0.0, 0.21})),  // farther than half the size
      MakeObject(3, MappedAs(walker)),
      MakeObject(4, MappedAs(truths[1])),
  };
  report.objects[4].state = ObjectState::kCandidate;
  const GroundtruthComparison comparison = CompareWithTruth(truths, report, {});
  ASSERT_EQ(comparison.errors.size(), 2U);
  EXPECT_EQ(comparison.errors[0].object, ObjectId(1));
  EXPECT_EQ(comparison.errors[1].object, ObjectId(0));
  EXPECT_EQ(comparison.times_mapped, (std::vector<size_t>{2, 0, 0}));
  EXPECT_EQ(comparison.without_truth, (std::vector<ObjectId>{ObjectId(2), ObjectId(3)}));
}

TEST(ObjectGroundtruth, OnlyObjectsSeenOftenEnoughCanBeMissed) {
  TrueObject walker = MakeTruth({3, 0, 0}, "person");
  walker.is_dynamic = true;
  const std::vector<TrueObject> truths = {MakeTruth({0, 0, 0}), MakeTruth({1, 0, 0}),
                                          MakeTruth({2, 0, 0}), MakeTruth({4, 0, 0}), walker};
  GroundtruthComparison comparison;
  comparison.times_mapped = {1, 2, 0, 0, 0};
  const TruthCounts all = CountMapped(truths, comparison, {}, 30);
  EXPECT_EQ(all.visible, 4U);
  EXPECT_EQ(all.once, 1U);
  EXPECT_EQ(all.more, 1U);
  EXPECT_EQ(all.never, 2U);
  const TruthCounts seen =
      CountMapped(truths, comparison, std::vector<size_t>{30, 40, 50, 29, 99}, 30);
  EXPECT_EQ(seen.visible, 3U);
  EXPECT_EQ(seen.never, 1U);
}

TEST(ObjectGroundtruth, ErrorsAreSummarizedByShapeOverTheNearestMappedObjects) {
  std::vector<TrueObject> truths = {MakeTruth({0, 0, 0}), MakeTruth({1, 0, 0}),
                                    MakeTruth({2, 0, 0})};
  truths[0].shape = truths[1].shape = "ellipsoid";
  truths[2].shape = "box";
  ObjectResults report;
  Ellipsoid larger = MappedAs(truths[1], {0.04, 0.0, 0.0});
  larger.half_axes *= 1.2;
  report.objects = {MakeObject(0, MappedAs(truths[0])),
                    MakeObject(1, MappedAs(truths[0], {0.1, 0.0, 0.0})), MakeObject(2, larger)};
  report.objects[0].fit.siou = 0.9;
  report.objects[1].fit.siou = 0.1;
  report.objects[2].fit.siou = 0.8;
  const auto shapes = SummarizeByShape(truths, CompareWithTruth(truths, report, {}));
  ASSERT_EQ(shapes.size(), 1U);
  const ShapeErrors& ellipsoids = shapes.at("ellipsoid");
  EXPECT_EQ(ellipsoids.objects, 2U);
  EXPECT_NEAR(ellipsoids.center_share_mean, 0.05, 1e-12);
  EXPECT_NEAR(ellipsoids.center_share_max, 0.1, 1e-12);
  EXPECT_NEAR(ellipsoids.axis_ratio_mean, 1.1, 1e-12);
  EXPECT_NEAR(ellipsoids.axis_ratio_deviation, 0.2, 1e-12);
  ASSERT_TRUE(ellipsoids.siou_mean.has_value());
  EXPECT_NEAR(*ellipsoids.siou_mean, 0.85, 1e-12);
}

TEST(ObjectGroundtruth, ASightingNeedsTheSameClassAndEnoughOverlap) {
  PinholeCamera camera;
  camera.fx = camera.fy = 500.0;
  camera.cx = 320.0;
  camera.cy = 240.0;
  const std::vector<TrueObject> truths = {MakeTruth({0, 0, 2}), MakeTruth({0.1, 0, 2}, "bowl"),
                                          MakeTruth({0, 0, -2}), MakeTruth({0.8, 0, 2})};
  const auto around = [](double x) {
    return Eigen::AlignedBox2d(Eigen::Vector2d(x - 50, 190), Eigen::Vector2d(x + 50, 290));
  };
  std::vector<size_t> sightings(4, 0);
  CountSightings(truths, camera, {}, std::vector<SeenBox>{{"cup", around(320)}}, sightings);
  EXPECT_EQ(sightings, (std::vector<size_t>{1, 0, 0, 0}));
  const std::vector<SeenBox> both = {
      {"bowl", around(340)}, {"cup", around(330)}, {"cup", around(310)}, {"vase", around(330)}};
  CountSightings(truths, camera, {}, both, sightings);
  EXPECT_EQ(sightings, (std::vector<size_t>{
                           2, 1, 0, 0}));  // two detections of one frame count as one sighting
  CountSightings(truths, camera, {}, std::vector<SeenBox>{{"cup", around(100)}}, sightings);
  EXPECT_EQ(sightings, (std::vector<size_t>{2, 1, 0, 0}));
  CountSightings(truths, camera, {}, std::vector<SeenBox>{{"cup", around(525)}}, sightings);
  EXPECT_EQ(sightings, (std::vector<size_t>{2, 1, 0, 1}));
}

TEST(ObjectGroundtruth, SightingsNeedOneCountPerTrueObject) {
  std::vector<size_t> none;
  EXPECT_THROW(CountSightings(std::vector<TrueObject>(1), PinholeCamera(), {}, {}, none),
               CheckError);
}

TEST(ObjectGroundtruth, ObjectsWithoutOverlapAreNotInItsMean) {
  std::vector<TrueObject> truths = {MakeTruth({0, 0, 0}), MakeTruth({1, 0, 0})};
  ObjectResults report;
  report.objects = {MakeObject(0, MappedAs(truths[0])), MakeObject(1, MappedAs(truths[1]))};
  report.objects[1].fit.siou = 0.8;
  const auto shapes = SummarizeByShape(truths, CompareWithTruth(truths, report, {}));
  ASSERT_EQ(shapes.size(), 1U);
  EXPECT_EQ(shapes.begin()->second.objects, 2U);
  EXPECT_EQ(shapes.begin()->second.siou_mean, 0.8);
}

}  // namespace

}  // namespace hullslam
