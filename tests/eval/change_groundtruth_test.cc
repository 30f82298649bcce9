// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <vector>

#include "eval/object_groundtruth.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

Rigid3 At(double x) { return Rigid3(Eigen::Quaterniond::Identity(), {x, 0.0, 0.0}); }

TrueObject Truth(double x, TrueObjectStatus status, double former = 0.0) {
  TrueObject truth;
  truth.world_from_object = At(x);
  truth.half_extents = {0.1, 0.1, 0.1};  // size 0.2
  truth.status = status;
  if (status == TrueObjectStatus::kMoved) {
    truth.former_world_from_object = At(former);
  }
  return truth;
}

ChangedObject Changed(ObjectChange change, std::optional<double> former, std::optional<double> now,
                      const Rigid3& map_from_truth = Rigid3()) {
  const auto located = [&](double x) {
    return LocatedObject{ObjectId(1), {map_from_truth * At(x)}};
  };
  ChangedObject changed;
  changed.change = change;
  if (former) {
    changed.former = located(*former);
  }
  if (now) {
    changed.now = located(*now);
  }
  return changed;
}

void ExpectCounts(const ChangeCounts& counts, size_t in_truth, size_t reported, size_t right) {
  EXPECT_EQ(counts.in_truth, in_truth);
  EXPECT_EQ(counts.reported, reported);
  EXPECT_EQ(counts.right, right);
}

// A scene in which objects were moved from 1 to 2 and from 3 to 4, one is new at 5, one is gone
// from 6, and one stayed.
TrueScene MakeScene() {
  TrueScene scene;
  scene.is_rearranged = true;
  scene.objects = {Truth(2.0, TrueObjectStatus::kMoved, 1.0),
                   Truth(4.0, TrueObjectStatus::kMoved, 3.0), Truth(5.0, TrueObjectStatus::kNew),
                   Truth(7.0, TrueObjectStatus::kUnchanged)};
  scene.gone = {Truth(6.0, TrueObjectStatus::kUnchanged)};
  return scene;
}

TEST(ChangeGroundtruth, CountsRightReportsInAnyWorldFrame) {
  RandomGeometry random(8);
  const Rigid3 map_from_truth = random.Pose(2.0, 5.0);
  const std::vector<ChangedObject> changes = {
      Changed(ObjectChange::kMoved, 1.05, 2.05, map_from_truth),
      Changed(ObjectChange::kMoved, 3.0, 4.0, map_from_truth),
      Changed(ObjectChange::kNew, {}, 5.0, map_from_truth),
      Changed(ObjectChange::kGone, 6.0, {}, map_from_truth),
      Changed(ObjectChange::kSeenAgain, 7.0, 7.0, map_from_truth)};
  const ChangeComparison comparison =
      CompareChanges(MakeScene(), changes, Sim3(Inverse(map_from_truth)), {}, 1);
  ExpectCounts(comparison.moved, 2, 2, 2);
  ExpectCounts(comparison.added, 1, 1, 1);
  ExpectCounts(comparison.gone, 1, 1, 1);
  ExpectCounts(comparison.left, 3, 3, 3);
  ExpectCounts(comparison.taken, 3, 3, 3);
}

// The map of a monocular run has a unit of length of its own.
TEST(ChangeGroundtruth, PlacesAreComparedInMetresInAMapOfAnyUnit) {
  const Sim3 truth_from_map(10.0, Eigen::Quaterniond::Identity(), {1.0, 0.0, 0.0});
  const std::vector<ChangedObject> changes = {Changed(ObjectChange::kMoved, 0.005, 0.105),
                                              Changed(ObjectChange::kGone, 6.0, {})};
  const ChangeComparison comparison = CompareChanges(MakeScene(), changes, truth_from_map, {}, 1);
  ExpectCounts(comparison.moved, 2, 1, 1);
  ExpectCounts(comparison.gone, 1, 1, 0);
}

// If the report pairs the old and new places of two moved objects wrongly, the places are still
// right.
TEST(ChangeGroundtruth, PairsMatterForMovedObjectsButNotForPlaces) {
  const std::vector<ChangedObject> changes = {Changed(ObjectChange::kMoved, 1.0, 4.0),
                                              Changed(ObjectChange::kMoved, 3.0, 2.0)};
  const ChangeComparison comparison = CompareChanges(MakeScene(), changes, Sim3(), {}, 1);
  ExpectCounts(comparison.moved, 2, 2, 0);
  ExpectCounts(comparison.left, 3, 2, 2);
  ExpectCounts(comparison.taken, 3, 2, 2);
}

TEST(ChangeGroundtruth, DistantAndRepeatedReportsAreWrong) {
  const std::vector<ChangedObject> changes = {
      Changed(ObjectChange::kNew, {}, 5.11), Changed(ObjectChange::kNew, {}, 5.0),
      Changed(ObjectChange::kNew, {}, 5.0), Changed(ObjectChange::kGone, 7.0, {})};
  const ChangeComparison comparison = CompareChanges(MakeScene(), changes, Sim3(), {}, 1);
  ExpectCounts(comparison.added, 1, 3, 1);
  ExpectCounts(comparison.gone, 1, 1, 0);
}

TEST(ChangeGroundtruth, ObjectsWithTooFewSightingsAreLeftOut) {
  const std::vector<size_t> sightings = {9, 10, 9, 10};
  const ChangeComparison comparison = CompareChanges(MakeScene(), {}, Sim3(), sightings, 10);
  ExpectCounts(comparison.moved, 1, 0, 0);
  ExpectCounts(comparison.added, 0, 0, 0);
}

TEST(ChangeGroundtruth, ThingsThatMoveByThemselvesAreNotChanges) {
  TrueScene scene = MakeScene();
  for (TrueObject& object : scene.objects) {
    object.is_dynamic = true;
  }
  const ChangeComparison comparison = CompareChanges(scene, {}, Sim3(), {}, 1);
  ExpectCounts(comparison.moved, 0, 0, 0);
  ExpectCounts(comparison.added, 0, 0, 0);
  ExpectCounts(comparison.gone, 1, 0, 0);
}

// The objects are 0.2 m large.
TEST(ChangeGroundtruth, BothPlacesMustBeWithinHalfOfTheSize) {
  const auto right = [](double former, double now) {
    const std::vector<ChangedObject> changes = {Changed(ObjectChange::kMoved, former, now)};
    return CompareChanges(MakeScene(), changes, Sim3(), {}, 1).moved.right;
  };
  EXPECT_EQ(right(1.09, 1.91), 1U);
  EXPECT_EQ(right(1.11, 2.0), 0U);
  EXPECT_EQ(right(1.0, 1.89), 0U);
}

}  // namespace
}  // namespace hullslam
