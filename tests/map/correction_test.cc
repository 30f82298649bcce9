// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/correction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/util/check.h"
#include "map/islands.h"
#include "map/keyframe_graph.h"
#include "map/landmark_edits.h"
#include "map/landmark_projection.h"
#include "map/made_correction.h"
#include "map/made_map.h"
#include "map/random_edits.h"
#include "map_files/invariants.h"
#include "support/pose_distance.h"
#include "support/random_geometry.h"
#include "support/synthetic_world.h"
#include "system/compose_trajectory.h"

namespace hullslam {
namespace {

constexpr uint32_t kSeeds = 12;

ScaleLevels Levels() { return ScaleLevels::Create(8, 1.2); }

Rigid3 Shift(double x) { return {Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, 0.0, 0.0)}; }

std::vector<KeyframeId> AllIds(const Map& map) {
  std::vector<KeyframeId> ids;
  for (uint32_t i = 0; i < map.keyframes().NextId().value; ++i) {
    ids.emplace_back(i);
  }
  return ids;
}

Ellipsoid RandomEllipsoid(RandomGeometry& random) {
  const double x = random.Number(0.05, 0.3);
  const double y = random.Number(0.05, 0.3);
  return {random.Pose(2.0, 3.0), {x, y, random.Number(0.05, 0.3)}};
}

void GiveShape(Map& map, ObjectId id, RandomGeometry& random) {
  ObjectLandmark& object = map.MutableObject(id);
  object.has_shape = true;
  object.state = object.observations.empty() ? ObjectState::kCandidate : ObjectState::kMapped;
  object.shaped_views = 4;
  object.ellipsoid = RandomEllipsoid(random);
  object.start = RandomEllipsoid(random);
  object.misfit_samples.assign(2, {});
  for (auto& sample : object.misfit_samples) {
    sample.normal = random.Vector(1.0).normalized().cast<float>();
    sample.excess = static_cast<float>(random.Number(-0.02, 0.02));
  }
}

void GiveShapes(Map& map, RandomGeometry& random) {
  for (uint32_t i = 0; i < map.objects().NextId().value; ++i) {
    if (map.objects().Contains(ObjectId(i)) && !map.objects().At(ObjectId(i)).has_shape) {
      GiveShape(map, ObjectId(i), random);
    }
  }
}

// A camera that moves with the world sees a moved point in the same direction as before, `scale`
// times as far away.
void ExpectMoved(const Rigid3& after, const Rigid3& before, const Sim3& new_from_old,
                 const std::string& what) {
  const Eigen::Vector3d center = Inverse(before).translation;
  EXPECT_LT((Inverse(after).translation - new_from_old * center).norm(), 1e-9) << what;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d point = center + Eigen::Vector3d::Unit(axis);
    const Eigen::Vector3d seen = after * (new_from_old * point);
    EXPECT_LT((seen - new_from_old.scale * (before * point)).norm(), 1e-9) << what;
  }
}

void ExpectMoved(const Ellipsoid& after, const Ellipsoid& before, const Sim3& new_from_old) {
  EXPECT_LT((after.half_axes - new_from_old.scale * before.half_axes).norm(), 1e-12);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d end = before.half_axes[axis] * Eigen::Vector3d::Unit(axis);
    EXPECT_LT((after.world_from_object * (new_from_old.scale * end) -
               new_from_old * (before.world_from_object * end))
                  .norm(),
              1e-9);
  }
}

// All numbers of a map that a correction may change, in a fixed order. The numbers of misfit
// samples are left out, because they have single precision.
std::vector<double> Numbers(const Map& map) {
  std::vector<double> numbers;
  const auto add = [&](const auto& matrix) {
    for (const double number : matrix.reshaped()) {
      numbers.push_back(number);
    }
  };
  for (const KeyframeId id : AllIds(map)) {
    add(map.CamFromWorld(id).ToMatrix());
    numbers.push_back(map.ScaleOf(id));
  }
  map.landmarks().ForEach([&](LandmarkId, const Landmark& landmark) {
    add(landmark.position);
    add(landmark.viewing_direction);
    numbers.push_back(landmark.min_distance);
    numbers.push_back(landmark.max_distance);
  });
  map.objects().ForEach([&](ObjectId, const ObjectLandmark& object) {
    for (const Ellipsoid& ellipsoid : {object.ellipsoid, object.start}) {
      add(ellipsoid.world_from_object.ToMatrix());
      add(ellipsoid.half_axes);
    }
  });
  return numbers;
}

std::vector<float> Excesses(const Map& map) {
  std::vector<float> excesses;
  map.objects().ForEach([&](ObjectId, const ObjectLandmark& object) {
    for (const MisfitSample& sample : object.misfit_samples) {
      excesses.push_back(sample.excess);
    }
  });
  return excesses;
}

void ExpectNear(const Map& a, const Map& b, double tolerance) {
  const std::vector<double> numbers_a = Numbers(a);
  const std::vector<double> numbers_b = Numbers(b);
  ASSERT_EQ(numbers_a.size(), numbers_b.size());
  for (size_t i = 0; i < numbers_a.size(); ++i) {
    ASSERT_NEAR(numbers_a[i], numbers_b[i], tolerance) << i;
  }
  const std::vector<float> excesses_a = Excesses(a);
  const std::vector<float> excesses_b = Excesses(b);
  ASSERT_EQ(excesses_a.size(), excesses_b.size());
  for (size_t i = 0; i < excesses_a.size(); ++i) {
    ASSERT_NEAR(excesses_a[i], excesses_b[i], std::max(tolerance, 1e-8)) << i;
  }
}

// A map and a correction of an older snapshot of it. Since the snapshot, keyframes and landmarks
// were made, moved, merged, erased and culled at random.
class LateCorrection : public ::testing::TestWithParam<uint32_t> {
 protected:
  LateCorrection() {
    Edit(250);
    GiveShapes(map_, random_);
    // The scales of the keyframes differ from here on.
    const MapCorrection former = MakeCorrection(map_, RandomChange(2.0));
    EXPECT_TRUE(ApplyCorrection(map_, former, levels_).is_applied);
    Edit(50);
    GiveShapes(map_, random_);
    snapshot_ = map_.Snapshot();
    TrackFrames();
    Edit(150);
    GiveShapes(map_, random_);
    TrackFrames();
  }

  void Edit(int count) {
    for (int i = 0; i < count; ++i) {
      edits_.Edit(map_);
    }
  }

  // Frames relative to every keyframe, also to culled ones. No keyframe was made of them.
  void TrackFrames() {
    for (const KeyframeId id : AllIds(map_)) {
      TrackedFrame& frame = frames_.emplace_back();
      frame.frame = FrameId(kFramesPerKeyframe * id.value + 1);
      frame.timestamp = static_cast<double>(frames_.size());
      frame.state = TrackingState::kTracked;
      frame.from_keyframe = map_.RelativeTo(id, random_.Pose(1.0, 2.0));
    }
  }

  std::function<Sim3(KeyframeId)> RandomChange(double factor) {
    return [this, factor](KeyframeId) { return RandomSim3(random_, factor); };
  }

  // A correction of the snapshot with a different change for every keyframe. `changes_` stores
  // them.
  MapCorrection MakeLateCorrection(double factor) {
    return MakeCorrection(snapshot_, [this, factor](KeyframeId id) {
      return changes_[id] = RandomSim3(random_, factor);
    });
  }

  // The change of the nearest ancestor that the correction names, found link by link.
  std::optional<Sim3> ExpectedChange(const Map& map, KeyframeId id) const {
    while (id.IsValid()) {
      if (const auto found = changes_.find(id); found != changes_.end()) {
        return found->second;
      }
      const CulledKeyframe* culled = map.FindCulled(id);
      id = culled != nullptr ? culled->pose.reference : map.keyframes().At(id).parent;
    }
    return std::nullopt;
  }

  void ExpectKeyframesMoved(const Map& before) const {
    for (const KeyframeId id : AllIds(before)) {
      const Sim3 change = ExpectedChange(before, id).value_or(Sim3());
      const std::string what = "keyframe " + std::to_string(id.value);
      ExpectMoved(map_.CamFromWorld(id), before.CamFromWorld(id), change, what);
      EXPECT_NEAR(map_.ScaleOf(id), before.ScaleOf(id) * change.scale, 1e-9) << what;
    }
  }

  void ExpectLandmarksMoved(const Map& before) const {
    before.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
      const Sim3 change = ExpectedChange(before, landmark.reference).value_or(Sim3());
      const Eigen::Vector3d moved = map_.landmarks().At(id).position;
      EXPECT_LT((moved - change * landmark.position).norm(), 1e-9) << id.value;
    });
  }

  void ExpectObjectsMoved(const Map& before) const {
    before.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
      const Sim3 change = ExpectedChange(before, object.reference).value_or(Sim3());
      const ObjectLandmark& moved = map_.objects().At(id);
      ExpectMoved(moved.ellipsoid, object.ellipsoid, change);
      ExpectMoved(moved.start, object.start, change);
      for (size_t i = 0; i < object.misfit_samples.size(); ++i) {
        EXPECT_EQ(moved.misfit_samples[i].normal, object.misfit_samples[i].normal);
        const auto before = static_cast<double>(object.misfit_samples[i].excess);
        EXPECT_NEAR(moved.misfit_samples[i].excess, change.scale * before,
                    1.2e-7 * change.scale * std::abs(before));
      }
    });
  }

  void ExpectFramesMoved(const Map& before) const {
    const Trajectory old_trajectory = ComposeTrajectory(before, frames_);
    const Trajectory new_trajectory = ComposeTrajectory(map_, frames_);
    ASSERT_EQ(old_trajectory.size(), frames_.size());
    ASSERT_EQ(new_trajectory.size(), frames_.size());
    for (size_t i = 0; i < frames_.size(); ++i) {
      ExpectMoved(Inverse(new_trajectory[i].world_from_cam),
                  Inverse(old_trajectory[i].world_from_cam),
                  ExpectedChange(before, frames_[i].from_keyframe->reference).value_or(Sim3()),
                  "frame " + std::to_string(i));
    }
  }

  const ScaleLevels levels_ = Levels();
  RandomGeometry random_{GetParam()};
  RandomEdits edits_{GetParam() + 1000};
  Map map_;
  Map snapshot_;
  std::vector<TrackedFrame> frames_;
  std::map<KeyframeId, Sim3> changes_;
};

INSTANTIATE_TEST_SUITE_P(Seeds, LateCorrection, ::testing::Range(0u, kSeeds));

TEST_P(LateCorrection, MovesEverythingByTheChangeOfItsNearestNamedAncestor) {
  for (const double factor : {1.0, 3.0}) {
    Map before = map_.Snapshot();
    changes_.clear();
    MapCorrection correction = MakeLateCorrection(factor);
    correction.snapshot_corrections = map_.correction_count();
    EXPECT_TRUE(ApplyCorrection(map_, correction, levels_).is_applied);
    ExpectKeyframesMoved(before);
    ExpectLandmarksMoved(before);
    ExpectObjectsMoved(before);
    ExpectFramesMoved(before);
    ASSERT_EQ(FindViolations(map_), std::vector<std::string>());
  }
}

TEST_P(LateCorrection, WithoutChangeOfScaleKeepsAllScales) {
  std::vector<double> scales;
  for (const KeyframeId id : AllIds(map_)) {
    scales.push_back(map_.ScaleOf(id));
  }
  EXPECT_TRUE(ApplyCorrection(map_, MakeLateCorrection(1.0), levels_).is_applied);
  for (const KeyframeId id : AllIds(map_)) {
    EXPECT_NEAR(map_.ScaleOf(id), scales[id.value], 1e-12);
    if (map_.keyframes().Contains(id)) {
      EXPECT_EQ(map_.ScaleOf(id), scales[id.value]);
    }
  }
}

TEST_P(LateCorrection, ByIdentityChangesNoBit) {
  MapCorrection correction = MakeIdentity(snapshot_);
  map_.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    correction.positions.push_back({id, landmark.position});
  });
  const std::string before = Dump(map_);
  EXPECT_TRUE(ApplyCorrection(map_, correction, levels_).is_applied);
  EXPECT_EQ(Dump(map_), before);
  EXPECT_EQ(map_.correction_count(), snapshot_.correction_count() + 1);
}

// Only the neighbourhood of one keyframe moves.
TEST_P(LateCorrection, DoesNotChangeEntitiesThatFollowAnIdentity) {
  MapCorrection correction = MakeIdentity(snapshot_);
  const KeyframeId moved = correction.poses.back().keyframe;
  const Sim3 change = RandomSim3(random_);
  correction.poses.back().corrected_cam_from_world =
      Sim3(correction.poses.back().snapshot_cam_from_world) * Inverse(change);
  for (const MapCorrection::Pose& pose : correction.poses) {
    changes_[pose.keyframe] = pose.keyframe == moved ? change : Sim3();
  }
  Map before = map_.Snapshot();
  EXPECT_TRUE(ApplyCorrection(map_, correction, levels_).is_applied);
  ExpectKeyframesMoved(before);
  before.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    const Sim3 expected = ExpectedChange(before, id).value_or(Sim3());
    const Keyframe& after = map_.keyframes().At(id);
    if (expected.scale == 1.0) {
      EXPECT_EQ(after.cam_from_world.rotation.coeffs(), keyframe.cam_from_world.rotation.coeffs());
      EXPECT_EQ(after.cam_from_world.translation, keyframe.cam_from_world.translation);
    }
  });
}

TEST_P(LateCorrection, IsRefusedIfTheMapWasCorrectedSince) {
  const MapCorrection stale = MakeLateCorrection(2.0);
  EXPECT_TRUE(ApplyCorrection(map_, MakeLateCorrection(2.0), levels_).is_applied);
  const std::string before = Dump(map_);
  const uint32_t count = map_.correction_count();
  const CorrectionOutcome outcome = ApplyCorrection(map_, stale, levels_);
  EXPECT_FALSE(outcome.is_applied);
  EXPECT_TRUE(outcome.merged_objects.empty());
  EXPECT_EQ(Dump(map_), before);
  EXPECT_EQ(map_.correction_count(), count);
}

// Some of the landmarks, objects and keyframes of the merges and the loop edge no longer exist.
TEST_P(LateCorrection, KeepsTheMapConsistent) {
  MapCorrection correction = MakeLateCorrection(2.0);
  const uint32_t keyframes = map_.keyframes().NextId().value;
  const uint32_t landmarks = static_cast<uint32_t>(map_.landmarks().slots()) + 1;
  const uint32_t objects = map_.objects().NextId().value + 1;
  for (int i = 0; i < 40; ++i) {
    correction.landmarks.push_back(
        {LandmarkId(random_.Index(landmarks)), LandmarkId(random_.Index(landmarks))});
    correction.positions.push_back({LandmarkId(random_.Index(landmarks)), random_.Vector(3.0)});
  }
  for (int i = 0; i < 4; ++i) {
    correction.objects.push_back(
        {ObjectId(random_.Index(objects)), ObjectId(random_.Index(objects))});
  }
  correction.loop = {KeyframeId(random_.Index(keyframes)), KeyframeId(random_.Index(keyframes))};
  const CorrectionOutcome outcome = ApplyCorrection(map_, correction, levels_);
  EXPECT_TRUE(outcome.is_applied);
  EXPECT_EQ(FindViolations(map_), std::vector<std::string>());
  EXPECT_TRUE(std::is_sorted(outcome.merged_objects.begin(), outcome.merged_objects.end()));
  for (const ObjectId id : outcome.merged_objects) {
    EXPECT_EQ(map_.objects().At(id).state, ObjectState::kCandidate);
  }
  Edit(100);
  EXPECT_EQ(FindViolations(map_), std::vector<std::string>());
}

// A correction B after a correction A is one correction with the products of their changes.
TEST_P(LateCorrection, ComposesWithTheNextCorrection) {
  // Viewing geometry must be up to date, as a correction to_cull it.
  EXPECT_TRUE(ApplyCorrection(map_, MakeLateCorrection(2.0), levels_).is_applied);
  std::map<KeyframeId, Sim3> first;
  std::map<KeyframeId, Sim3> second;
  for (const KeyframeId id : AllIds(map_)) {
    first[id] = RandomSim3(random_, 2.0);
    second[id] = RandomSim3(random_, 2.0);
  }
  Map twice = map_.Snapshot();
  for (const auto& changes : {first, second}) {
    const MapCorrection correction =
        MakeCorrection(twice, [&](KeyframeId id) { return changes.at(id); });
    EXPECT_TRUE(ApplyCorrection(twice, correction, levels_).is_applied);
  }
  const MapCorrection correction =
      MakeCorrection(map_, [&](KeyframeId id) { return second.at(id) * first.at(id); });
  EXPECT_TRUE(ApplyCorrection(map_, correction, levels_).is_applied);
  ExpectNear(twice, map_, 1e-9);
  for (const TrackedFrame& frame : frames_) {
    EXPECT_LT(
        Distance(twice.CamFromWorld(*frame.from_keyframe), map_.CamFromWorld(*frame.from_keyframe)),
        1e-9);
  }
}

// Poses are the same whether a keyframe is culled just before a correction or just after it.
TEST_P(LateCorrection, CommutesWithCulling) {
  map_ = snapshot_.Snapshot();
  const MapCorrection correction = MakeLateCorrection(3.0);
  std::vector<KeyframeId> to_cull;
  snapshot_.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    if (keyframe.parent.IsValid() && id.value % 2 == 0) {
      to_cull.push_back(id);
    }
  });
  ASSERT_FALSE(to_cull.empty());
  Map culled_after = map_.Snapshot();
  for (const KeyframeId id : to_cull) {
    map_.CullKeyframe(id);
  }
  EXPECT_TRUE(ApplyCorrection(map_, correction, levels_).is_applied);
  EXPECT_TRUE(ApplyCorrection(culled_after, correction, levels_).is_applied);
  for (const KeyframeId id : to_cull) {
    culled_after.CullKeyframe(id);
  }
  for (const KeyframeId id : AllIds(map_)) {
    EXPECT_LT(Distance(map_.CamFromWorld(id), culled_after.CamFromWorld(id)), 1e-9) << id.value;
    EXPECT_NEAR(map_.ScaleOf(id), culled_after.ScaleOf(id), 1e-9) << id.value;
  }
  for (const TrackedFrame& frame : frames_) {
    if (frame.from_keyframe->reference < snapshot_.keyframes().NextId()) {
      EXPECT_LT(Distance(map_.CamFromWorld(*frame.from_keyframe),
                         culled_after.CamFromWorld(*frame.from_keyframe)),
                1e-9);
    }
  }
}

TEST_P(LateCorrection, KeepsRelativePosesUpToScaleWhereChangesAreEqual) {
  Map before = map_.Snapshot();
  const Sim3 change = RandomSim3(random_);
  for (const MapCorrection::Pose& pose : MakeCorrection(snapshot_, change).poses) {
    changes_[pose.keyframe] = change;
  }
  EXPECT_TRUE(ApplyCorrection(map_, MakeCorrection(snapshot_, change), levels_).is_applied);
  KeyframeId last;
  for (const KeyframeId id : AllIds(map_)) {
    if (!ExpectedChange(before, id)) {
      continue;
    }
    if (last.IsValid()) {
      Rigid3 expected = before.CamFromWorld(id) * Inverse(before.CamFromWorld(last));
      expected.translation *= change.scale;
      EXPECT_LT(Distance(map_.CamFromWorld(id) * Inverse(map_.CamFromWorld(last)), expected), 1e-9);
    }
    last = id;
  }
}

// Corrections and culls in turn: the frames keep their poses when keyframes are culled, however
// much the scales of the keyframes differ.
TEST_P(LateCorrection, FramesKeepTheirPosesInChainsOfCulledKeyframes) {
  for (int round = 0; round < 6; ++round) {
    EXPECT_TRUE(ApplyCorrection(map_, MakeCorrection(map_, RandomChange(2.0)), levels_).is_applied);
    const Map before = map_.Snapshot();
    int culled = 0;
    before.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
      if (keyframe.parent.IsValid() && random_.Index(3) == 0) {
        map_.CullKeyframe(id);
        ++culled;
      }
    });
    for (const TrackedFrame& frame : frames_) {
      EXPECT_LT(Distance(map_.CamFromWorld(*frame.from_keyframe),
                         before.CamFromWorld(*frame.from_keyframe)),
                1e-9);
    }
    for (const KeyframeId id : AllIds(map_)) {
      EXPECT_NEAR(map_.ScaleOf(id), before.ScaleOf(id), 1e-9);
    }
  }
}

// Three keyframes in a row, 1 below 0 and 2 below 1, at x = 1, 2 and 3 m, which look along z.
class CorrectionByHand : public ::testing::Test {
 protected:
  CorrectionByHand() {
    for (int i = 0; i < 3; ++i) {
      AddKeyframe(map_, 40, 10, Shift(-1.0 - i));
    }
    SetParent(map_, b_, a_);
    SetParent(map_, c_, b_);
  }

  // Adds the keyframe to the correction with a change that maps x to `scale` * x + `shift`.
  void Name(KeyframeId id, double scale, double shift) {
    const Sim3 new_from_old(scale, Eigen::Quaterniond::Identity(), {shift, 0.0, 0.0});
    const Rigid3& pose = map_.keyframes().At(id).cam_from_world;
    correction_.poses.push_back({id, pose, Sim3(pose) * Inverse(new_from_old)});
  }

  CorrectionOutcome Apply() { return ApplyCorrection(map_, correction_, Levels()); }

  double CenterX(KeyframeId id) const { return Inverse(map_.CamFromWorld(id)).translation.x(); }

  Map map_;
  MapCorrection correction_;
  const KeyframeId a_{0};
  const KeyframeId b_{1};
  const KeyframeId c_{2};
};

TEST_F(CorrectionByHand, MovesAndScales) {
  const LandmarkId landmark = Share(map_, {b_, c_}).front();  // at (0, 0, 2)
  RandomGeometry random(1);
  const ObjectId object = map_.AddObject();
  ASSERT_TRUE(map_.AddObservation(object, b_, 0));
  GiveShape(map_, object, random);
  map_.MutableObject(object).ellipsoid = {Shift(4.0), {0.1, 0.2, 0.3}};
  map_.MutableObject(object).start = {Shift(5.0), {0.2, 0.3, 0.4}};
  map_.MutableObject(object).misfit_samples[0].excess = -0.01f;
  Name(a_, 1.0, 0.0);
  Name(b_, 2.0, 10.0);
  Name(c_, 3.0, -1.0);
  EXPECT_TRUE(Apply().is_applied);
  EXPECT_DOUBLE_EQ(CenterX(a_), 1.0);
  EXPECT_DOUBLE_EQ(CenterX(b_), 14.0);
  EXPECT_DOUBLE_EQ(CenterX(c_), 8.0);
  EXPECT_DOUBLE_EQ(map_.keyframes().At(b_).scale, 2.0);
  EXPECT_DOUBLE_EQ(map_.keyframes().At(c_).scale, 3.0);
  EXPECT_LT((map_.landmarks().At(landmark).position - Eigen::Vector3d(10.0, 0.0, 4.0)).norm(),
            1e-12);
  const ObjectLandmark& moved = map_.objects().At(object);
  EXPECT_DOUBLE_EQ(moved.ellipsoid.world_from_object.translation.x(), 18.0);
  EXPECT_DOUBLE_EQ(moved.ellipsoid.half_axes.z(), 0.6);
  EXPECT_DOUBLE_EQ(moved.start.world_from_object.translation.x(), 20.0);
  EXPECT_DOUBLE_EQ(moved.start.half_axes.x(), 0.4);
  EXPECT_FLOAT_EQ(moved.misfit_samples[0].excess, -0.02f);
  EXPECT_EQ(moved.state, ObjectState::kMapped);  // moving a shape keeps it valid
}

// A change of scale alone, or of rotation alone, is not the identity.
TEST_F(CorrectionByHand, MovesByScaleAlone) {
  Name(a_, 1.0, 0.0);
  correction_.poses.back().corrected_cam_from_world.scale = 2.0;
  EXPECT_TRUE(Apply().is_applied);
  EXPECT_DOUBLE_EQ(CenterX(a_), 0.5);
  EXPECT_DOUBLE_EQ(map_.keyframes().At(a_).scale, 0.5);
}

TEST_F(CorrectionByHand, MovesByRotationAlone) {
  Name(a_, 1.0, 0.0);
  correction_.poses.back().corrected_cam_from_world.rotation =
      Eigen::Quaterniond(0.0, 0.0, 1.0, 0.0);  // half a turn around y
  EXPECT_TRUE(Apply().is_applied);
  EXPECT_DOUBLE_EQ(CenterX(a_), -1.0);
  EXPECT_LT(
      (map_.CamFromWorld(a_) * Eigen::Vector3d(0.0, 0.0, 1.0) - Eigen::Vector3d(-1.0, 0.0, -1.0))
          .norm(),
      1e-12);
}

// The culled keyframe b stays, although its pose is relative to a, which moves. So does c, which
// was culled before b and depends on both.
TEST_F(CorrectionByHand, ACulledKeyframeWithIdentityStays) {
  Name(a_, 2.0, 5.0);
  Name(b_, 1.0, 0.0);
  Name(c_, 1.0, 0.0);
  const RelativePose frame = map_.RelativeTo(c_, Shift(-7.0));
  map_.CullKeyframe(c_);
  map_.CullKeyframe(b_);
  EXPECT_TRUE(Apply().is_applied);
  EXPECT_DOUBLE_EQ(CenterX(a_), 7.0);
  EXPECT_DOUBLE_EQ(CenterX(b_), 2.0);
  EXPECT_DOUBLE_EQ(CenterX(c_), 3.0);
  EXPECT_DOUBLE_EQ(map_.ScaleOf(a_), 2.0);
  EXPECT_DOUBLE_EQ(map_.ScaleOf(b_), 1.0);
  EXPECT_DOUBLE_EQ(map_.ScaleOf(c_), 1.0);
  EXPECT_DOUBLE_EQ(map_.CamFromWorld(frame).translation.x(), -7.0);
}

TEST_F(CorrectionByHand, MovesKeyframesThatItDoesNotNameWithTheirAncestor) {
  Name(a_, 1.0, 5.0);
  const KeyframeId alone = AddKeyframe(map_, 1, 0, Shift(-20.0));
  const LandmarkId still = map_.AddLandmark({1.0, 2.0, 3.0}, alone);
  map_.CullKeyframe(b_);
  const KeyframeId late = AddKeyframe(map_, 1, 0, Shift(-4.0));
  SetParent(map_, late, c_);
  EXPECT_TRUE(Apply().is_applied);
  EXPECT_DOUBLE_EQ(CenterX(a_), 6.0);
  EXPECT_DOUBLE_EQ(CenterX(b_), 7.0);
  EXPECT_DOUBLE_EQ(CenterX(c_), 8.0);
  EXPECT_DOUBLE_EQ(CenterX(late), 9.0);
  EXPECT_EQ(CenterX(alone), 20.0);
  EXPECT_EQ(map_.landmarks().At(still).position, Eigen::Vector3d(1.0, 2.0, 3.0));
}

// The reference of an object without observations may be culled. Here the correction names it.
TEST_F(CorrectionByHand, MovesAnObjectWithItsCulledReference) {
  RandomGeometry random(2);
  const ObjectId object = map_.AddObject();
  ASSERT_TRUE(map_.AddObservation(object, b_, 0));
  GiveShape(map_, object, random);
  map_.MutableObject(object).ellipsoid = {Shift(4.0), {0.1, 0.2, 0.3}};
  Name(a_, 1.0, 5.0);
  Name(b_, 1.0, 7.0);
  map_.CullKeyframe(b_);
  EXPECT_TRUE(Apply().is_applied);
  EXPECT_DOUBLE_EQ(map_.objects().At(object).ellipsoid.world_from_object.translation.x(), 11.0);
  EXPECT_DOUBLE_EQ(CenterX(b_), 9.0);
  // The next snapshot does not have it any more.
  correction_ = {};
  correction_.snapshot_corrections = 1;
  Name(a_, 1.0, 100.0);
  EXPECT_TRUE(Apply().is_applied);
  EXPECT_DOUBLE_EQ(map_.objects().At(object).ellipsoid.world_from_object.translation.x(), 111.0);
  EXPECT_DOUBLE_EQ(CenterX(b_), 109.0);
}

// The keyframe was moved by 0.25 m and the landmark by 0.5 m after the snapshot.
TEST_F(CorrectionByHand, KeepsLocalAdjustments) {
  const LandmarkId landmark = Share(map_, {b_, c_}).front();
  Name(b_, 2.0, 10.0);
  map_.SetPose(b_, Shift(-2.25));
  map_.SetPosition(landmark, {0.5, 0.0, 2.0});
  EXPECT_TRUE(Apply().is_applied);
  EXPECT_DOUBLE_EQ(CenterX(b_), 14.5);
  EXPECT_LT((map_.landmarks().At(landmark).position - Eigen::Vector3d(11.0, 0.0, 4.0)).norm(),
            1e-12);
}

TEST_F(CorrectionByHand, MovesLandmarksToGivenPositions) {
  const std::vector<LandmarkId> landmarks = Share(map_, {b_, c_}, 4);
  for (int i = 0; i < 3; ++i) {
    correction_.positions.push_back(
        {landmarks[static_cast<size_t>(i)], Eigen::Vector3d(1.0 + i, 2.0, 3.0)});
  }
  correction_.positions.push_back({LandmarkId(99), Eigen::Vector3d::Zero()});
  Name(a_, 1.0, 5.0);
  // An erased landmark is skipped. A replaced one is skipped too, because its position is not that
  // of its replacement.
  map_.EraseLandmark(landmarks[1]);
  map_.ReplaceLandmark(landmarks[2], landmarks[3]);
  EXPECT_TRUE(Apply().is_applied);
  EXPECT_EQ(map_.landmarks().At(landmarks[0]).position, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_FALSE(map_.landmarks().Contains(landmarks[1]));
  EXPECT_LT((map_.landmarks().At(landmarks[3]).position - Eigen::Vector3d(5.0, 0.0, 2.0)).norm(),
            1e-12);
}

// First only the landmark moves, then only the second of the two keyframes that observe it.
TEST_F(CorrectionByHand, ViewingGeometryFollowsPositionsAndObservers) {
  const LandmarkId landmark = Share(map_, {a_, c_}).front();
  UpdateViewingGeometry(map_, landmark, Levels());
  const double distance = map_.landmarks().At(landmark).max_distance;
  correction_.positions.push_back({landmark, {0.0, 0.0, 4.0}});
  EXPECT_TRUE(Apply().is_applied);
  EXPECT_NEAR(map_.landmarks().At(landmark).max_distance,
              distance * std::sqrt(17.0) / std::sqrt(5.0), 1e-12);
  correction_ = {};
  correction_.snapshot_corrections = 1;
  Name(c_, 1.0, 3.0);
  const Eigen::Vector3d direction = map_.landmarks().At(landmark).viewing_direction;
  EXPECT_TRUE(Apply().is_applied);
  const Eigen::Vector3d expected =
      (Eigen::Vector3d(-1.0, 0.0, 4.0).normalized() + Eigen::Vector3d(-6.0, 0.0, 4.0).normalized())
          .normalized();
  EXPECT_GT((direction - expected).norm(), 0.1);
  EXPECT_LT((map_.landmarks().At(landmark).viewing_direction - expected).norm(), 1e-12);
}

TEST_F(CorrectionByHand, MergesLandmarks) {
  const std::vector<LandmarkId> old_ones = Share(map_, {a_, b_}, 16);
  const std::vector<LandmarkId> new_ones = Share(map_, {c_}, 16);
  UpdateCovisibility(map_, a_);
  ASSERT_TRUE(map_.keyframes().At(c_).covisible.empty());
  // Two keyframes have the descriptor of the old landmarks, so it is the most typical.
  for (const KeyframeId id : {a_, b_}) {
    auto frame = std::make_shared<Frame>(*map_.keyframes().At(id).frame);
    std::fill(frame->features.descriptors.begin(), frame->features.descriptors.end(),
              Descriptor{7, 0, 0, 0});
    map_.MutableKeyframe(id).frame = frame;
  }
  for (size_t i = 0; i < old_ones.size(); ++i) {
    UpdateDescriptor(map_, new_ones[i]);
    correction_.landmarks.push_back({old_ones[i], new_ones[i]});
  }
  EXPECT_TRUE(Apply().is_applied);
  for (size_t i = 0; i < old_ones.size(); ++i) {
    EXPECT_EQ(map_.Resolve(old_ones[i]), new_ones[i]);
    const Landmark& kept = map_.landmarks().At(new_ones[i]);
    EXPECT_EQ(kept.observations.size(), 3u);
    EXPECT_EQ(kept.descriptor, (Descriptor{7, 0, 0, 0}));
    EXPECT_GT(kept.max_distance, 0.0);
  }
  const std::vector<Covisible>& edges = map_.keyframes().At(c_).covisible;
  ASSERT_EQ(edges.size(), 2u);
  EXPECT_EQ(edges[0].keyframe, a_);
  EXPECT_EQ(edges[0].shared, 16);
  EXPECT_EQ(edges[1].keyframe, b_);
  EXPECT_EQ(FindViolations(map_), std::vector<std::string>());
}

// A keyframe that shares fewer than 15 landmarks has its best edge only, so some edges are found
// only when covisibility is counted from their other end.
TEST_F(CorrectionByHand, RecountsCovisibilityOnBothSidesOfAMerge) {
  for (const bool keeps_the_old : {true, false}) {
    Map map = map_.Snapshot();
    const std::vector<LandmarkId> old_ones = Share(map, {a_, b_}, 20);
    const std::vector<LandmarkId> new_ones = Share(map, {c_}, 5);
    UpdateCovisibility(map, a_);
    MapCorrection correction;
    for (size_t i = 0; i < new_ones.size(); ++i) {
      const MapCorrection::LandmarkMerge merge{new_ones[i], old_ones[i]};
      correction.landmarks.push_back(
          keeps_the_old ? merge : MapCorrection::LandmarkMerge{merge.kept, merge.duplicate});
    }
    EXPECT_TRUE(ApplyCorrection(map, correction, Levels()).is_applied);
    const std::vector<Covisible>& edges = map.keyframes().At(c_).covisible;
    ASSERT_EQ(edges.size(), 1u);
    EXPECT_EQ(edges[0].keyframe, b_);
    EXPECT_EQ(edges[0].shared, 5);
    EXPECT_EQ(FindViolations(map), std::vector<std::string>());
  }
}

TEST_F(CorrectionByHand, FollowsTheIdsOfMerges) {
  const std::vector<LandmarkId> ids = Share(map_, {a_, b_}, 5);
  const std::vector<LandmarkId> others = Share(map_, {c_}, 4);
  map_.ReplaceLandmark(ids[0], ids[1]);
  map_.ReplaceLandmark(ids[2], ids[3]);
  map_.EraseLandmark(others[3]);
  correction_.landmarks = {{others[0], ids[0]},   // ids[0] is ids[1] now
                           {ids[2], others[1]},   // ids[2] is ids[3] now
                           {ids[1], ids[0]},      // the same landmark: skipped
                           {ids[4], others[3]},   // erased: skipped
                           {others[3], ids[4]}};  // likewise
  EXPECT_TRUE(Apply().is_applied);
  EXPECT_EQ(map_.Resolve(others[0]), ids[1]);
  EXPECT_EQ(map_.landmarks().At(ids[1]).observations.size(), 3u);
  EXPECT_EQ(map_.Resolve(ids[3]), others[1]);
  EXPECT_EQ(map_.landmarks().At(others[1]).observations.size(), 3u);
  EXPECT_EQ(map_.landmarks().At(ids[4]).observations.size(), 2u);
  EXPECT_EQ(FindViolations(map_), std::vector<std::string>());
}

// A landmark into which another was merged is merged into a third.
TEST_F(CorrectionByHand, MergesAreDoneInOrder) {
  const std::vector<LandmarkId> ids = Share(map_, {a_}, 2);
  const LandmarkId last = Share(map_, {b_}).front();
  const LandmarkId first = Share(map_, {c_}).front();
  correction_.landmarks = {{first, ids[0]}, {ids[0], last}, {first, ids[1]}};
  EXPECT_TRUE(Apply().is_applied);
  EXPECT_EQ(map_.Resolve(first), ids[1]);
  EXPECT_EQ(map_.Resolve(last), ids[1]);
  EXPECT_EQ(map_.landmarks().At(ids[1]).observations.size(), 3u);
  EXPECT_EQ(FindViolations(map_), std::vector<std::string>());
}

TEST_F(CorrectionByHand, MergedObjectsAreCandidatesWithAllVotes) {
  RandomGeometry random(3);
  std::vector<ObjectId> ids;
  for (int i = 0; i < 6; ++i) {
    ids.push_back(map_.AddObject());
  }
  ASSERT_TRUE(map_.AddObservation(ids[0], a_, 0));  // a cup of score 0.3
  ASSERT_TRUE(map_.AddObservation(ids[1], b_, 2));  // a cup of score 0.5
  ASSERT_TRUE(map_.AddObservation(ids[2], c_, 1));  // a book of score 0.4
  GiveShapes(map_, random);
  const ObjectLandmark untouched = map_.objects().At(ids[5]);
  const Ellipsoid shape = map_.objects().At(ids[1]).ellipsoid;
  map_.EraseObject(ids[4]);
  correction_.objects = {{ids[0], ids[3]},  // ids[3] is merged into ids[1] below
                         {ids[2], ids[1]},
                         {ids[3], ids[1]},
                         {ids[3], ids[1]},   // merged already
                         {ids[5], ids[4]}};  // ids[4] is gone
  const CorrectionOutcome outcome = Apply();
  EXPECT_EQ(outcome.merged_objects, std::vector<ObjectId>{ids[1]});
  const ObjectLandmark& merged = map_.objects().At(ids[1]);
  EXPECT_EQ(merged.state, ObjectState::kCandidate);
  EXPECT_EQ(merged.shaped_views, 0u);
  EXPECT_TRUE(merged.has_shape);
  EXPECT_EQ(merged.ellipsoid.half_axes, shape.half_axes);
  EXPECT_DOUBLE_EQ(merged.votes.at("cup"), 0.8);
  EXPECT_DOUBLE_EQ(merged.votes.at("book"), 0.4);
  EXPECT_EQ(merged.observations.size(), 3u);
  EXPECT_EQ(merged.reference, a_);
  EXPECT_EQ(map_.Resolve(ids[0]), ids[1]);
  EXPECT_EQ(map_.objects().At(ids[5]).state, untouched.state);
  EXPECT_EQ(map_.objects().At(ids[5]).shaped_views, untouched.shaped_views);
  EXPECT_EQ(FindViolations(map_), std::vector<std::string>());
}

TEST_F(CorrectionByHand, ALockedObjectIsKeptAsItIs) {
  RandomGeometry random(3);
  std::vector<ObjectId> ids;
  for (int i = 0; i < 3; ++i) {
    ids.push_back(map_.AddObject());
  }
  ASSERT_TRUE(map_.AddObservation(ids[0], a_, 0));
  ASSERT_TRUE(map_.AddObservation(ids[1], b_, 2));
  ASSERT_TRUE(map_.AddObservation(ids[2], c_, 1));
  GiveShapes(map_, random);
  for (const ObjectId id : {ids[0], ids[2]}) {
    map_.MutableObject(id).state = ObjectState::kMapped;
    map_.MutableObject(id).is_locked = true;
  }
  const Ellipsoid shape = map_.objects().At(ids[0]).ellipsoid;
  correction_.objects = {{ids[0], ids[1]}, {ids[2], ids[0]}};
  EXPECT_EQ(Apply().merged_objects, std::vector<ObjectId>{ids[0]});
  EXPECT_EQ(map_.Resolve(ids[1]), ids[0]);
  EXPECT_EQ(map_.Resolve(ids[2]), ids[2]) << "both are locked";
  EXPECT_TRUE(map_.objects().At(ids[0]).IsFixed());
  EXPECT_EQ(map_.objects().At(ids[0]).ellipsoid.half_axes, shape.half_axes);
  EXPECT_EQ(map_.objects().At(ids[0]).observations.size(), 2u);
}

TEST_F(CorrectionByHand, FollowsTheIdsOfMergedObjects) {
  std::vector<ObjectId> ids;
  for (int i = 0; i < 6; ++i) {
    ids.push_back(map_.AddObject());
  }
  map_.ReplaceObject(ids[0], ids[1]);
  map_.ReplaceObject(ids[3], ids[4]);
  correction_.objects = {{ids[2], ids[0]}, {ids[3], ids[5]}, {ids[0], ids[1]}};
  EXPECT_EQ(Apply().merged_objects, (std::vector<ObjectId>{ids[1], ids[5]}));
  EXPECT_EQ(map_.Resolve(ids[2]), ids[1]);
  EXPECT_EQ(map_.Resolve(ids[4]), ids[5]);
  EXPECT_EQ(map_.objects().size(), 2u);
}

TEST_F(CorrectionByHand, SkipsKeyframesThatTheMapNeverHad) {
  Name(a_, 1.0, 5.0);
  for (const KeyframeId id : {KeyframeId(99), KeyframeId()}) {
    correction_.poses.push_back({id, Rigid3(), Sim3(Shift(1.0))});
  }
  EXPECT_TRUE(Apply().is_applied);
  EXPECT_DOUBLE_EQ(CenterX(a_), 6.0);
}

TEST_F(CorrectionByHand, NeedsPositiveScales) {
  Name(a_, 2.0, 5.0);
  Name(b_, 1.0, 0.0);
  const std::string before = Dump(map_);
  for (const double scale : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
    correction_.poses.back().corrected_cam_from_world.scale = scale;
    EXPECT_THROW(Apply(), CheckError);
    EXPECT_EQ(Dump(map_), before);
  }
}

TEST_F(CorrectionByHand, KeepsTheLoopEdgeAtBothEnds) {
  const KeyframeId d = AddKeyframe(map_, 1, 0, Shift(-4.0));
  SetParent(map_, d, c_);
  map_.AddLoop(a_, d);
  correction_.loop = {d, b_};
  EXPECT_TRUE(Apply().is_applied);
  EXPECT_EQ(map_.keyframes().At(d).loops, (std::vector<KeyframeId>{a_, b_}));
  EXPECT_EQ(map_.keyframes().At(a_).loops, std::vector<KeyframeId>{d});
  EXPECT_EQ(map_.keyframes().At(b_).loops, std::vector<KeyframeId>{d});
  correction_.snapshot_corrections = 1;
  EXPECT_TRUE(Apply().is_applied);  // the same edge again
  EXPECT_EQ(map_.keyframes().At(d).loops, (std::vector<KeyframeId>{a_, b_}));
  EXPECT_EQ(FindViolations(map_), std::vector<std::string>());
}

TEST_F(CorrectionByHand, TheLoopEdgeOfACulledKeyframeGoesToItsNearestAncestor) {
  const KeyframeId d = AddKeyframe(map_, 1, 0, Shift(-4.0));
  SetParent(map_, d, c_);
  map_.CullKeyframe(c_);
  map_.CullKeyframe(b_);
  correction_.loop = {c_, d};
  EXPECT_TRUE(Apply().is_applied);
  EXPECT_EQ(map_.keyframes().At(a_).loops, std::vector<KeyframeId>{d});
  EXPECT_EQ(map_.keyframes().At(d).loops, std::vector<KeyframeId>{a_});
  for (const KeyframeId other : {b_, KeyframeId(99), KeyframeId()}) {
    correction_.snapshot_corrections = map_.correction_count();
    correction_.loop = {a_, other};  // to itself, or to a keyframe that never existed
    EXPECT_TRUE(Apply().is_applied);
    EXPECT_EQ(map_.keyframes().At(a_).loops, std::vector<KeyframeId>{d});
  }
}

// Each keyframe observes one object and all landmarks of the world.
class UniformCorrection : public ::testing::Test {
 protected:
  UniformCorrection()
      : made_(MakeSyntheticMap(world_, {0, 10, 20, 30, 40}, [](Frame& frame, const Rigid3&) {
          frame.detections.resize(kDetections);
          for (Detection& detection : frame.detections) {
            detection.label = "cup";
          }
        })) {
    RandomGeometry random(5);
    for (uint32_t i = 0; i < kDetections; ++i) {
      const ObjectId object = made_.map.AddObject();
      for (const KeyframeId id : AllIds(made_.map)) {
        made_.map.AddObservation(object, id, i);
      }
      GiveShape(made_.map, object, random);
      made_.map.MutableObject(object).ellipsoid.world_from_object.translation =
          random.Vector(0.8) + Eigen::Vector3d(0.0, 0.0, 4.0);
    }
  }

  const SyntheticWorld world_;
  SyntheticMap made_;
};

TEST_F(UniformCorrection, KeepsThePixelOfEveryLandmark) {
  RandomGeometry random(6);
  Map before = made_.map.Snapshot();
  for (int round = 0; round < 3; ++round) {
    const Sim3 change = RandomSim3(random);
    EXPECT_TRUE(
        ApplyCorrection(made_.map, MakeCorrection(made_.map, change), world_.sensor().levels)
            .is_applied);
    int seen = 0;
    before.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
      for (const Observation& observation : landmark.observations) {
        const auto expected =
            ProjectLandmark(world_.sensor(), before.CamFromWorld(observation.keyframe), landmark);
        const auto view =
            ProjectLandmark(world_.sensor(), made_.map.CamFromWorld(observation.keyframe),
                            made_.map.landmarks().At(id));
        ASSERT_EQ(view.has_value(), expected.has_value());
        if (view) {
          EXPECT_LT((view->pixel - expected->pixel).norm(), 1e-9);
          EXPECT_NEAR(view->cos_view, expected->cos_view, 1e-9);
          EXPECT_NEAR(made_.map.landmarks().At(id).max_distance / view->point_in_cam.norm(),
                      landmark.max_distance / expected->point_in_cam.norm(), 1e-9);
          ++seen;
        }
      }
    });
    EXPECT_GT(seen, 500);
  }
}

TEST_F(UniformCorrection, ScalingMakesAllLengthsLonger) {
  Map before = made_.map.Snapshot();
  const MapCorrection scaling = ScalingOf(made_.map, 2.5);
  EXPECT_TRUE(ApplyCorrection(made_.map, scaling, world_.sensor().levels).is_applied);
  EXPECT_EQ(FindViolations(made_.map), std::vector<std::string>());
  for (const KeyframeId id : AllIds(before)) {
    const Rigid3& pose = before.CamFromWorld(id);
    EXPECT_LT(Distance(made_.map.CamFromWorld(id), {pose.rotation, 2.5 * pose.translation}), 1e-9);
    EXPECT_NEAR(made_.map.ScaleOf(id), 2.5 * before.ScaleOf(id), 1e-12);
  }
  before.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    EXPECT_LT((made_.map.landmarks().At(id).position - 2.5 * landmark.position).norm(), 1e-9);
  });
  before.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    EXPECT_LT(
        (made_.map.objects().At(id).ellipsoid.half_axes - 2.5 * object.ellipsoid.half_axes).norm(),
        1e-9);
  });
}

TEST_F(UniformCorrection, KeepsTheProjectedEllipsesOfObjects) {
  RandomGeometry random(7);
  Map before = made_.map.Snapshot();
  EXPECT_TRUE(ApplyCorrection(made_.map, MakeCorrection(made_.map, RandomSim3(random)),
                              world_.sensor().levels)
                  .is_applied);
  const PinholeCamera& camera = world_.sensor().camera;
  const Eigen::Matrix3d k = camera.Matrix();
  before.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    for (const ObjectObservation& observation : object.observations) {
      const auto expected =
          ProjectEllipsoid(k, before.CamFromWorld(observation.keyframe), object.ellipsoid);
      const auto ellipse = ProjectEllipsoid(k, made_.map.CamFromWorld(observation.keyframe),
                                            made_.map.objects().At(id).ellipsoid);
      ASSERT_TRUE(expected && ellipse);
      EXPECT_LT((ellipse->center - expected->center).norm(), 1e-9);
      EXPECT_LT((ellipse->shape - expected->shape).norm(), 1e-9 * expected->shape.norm());
    }
  });
}

// The younger island has another unit of length and another world frame. The correction has the
// true poses.
TEST(JoinCorrection, MovesTheYoungerIslandAndMakesOneOfBoth) {
  RandomGeometry random(3);
  Map map;
  const ScaleLevels levels = ScaleLevels::Create(8, 1.2);
  for (int i = 0; i < 2; ++i) {
    const IslandId island = map.BeginIsland();
    std::vector<KeyframeId> added;
    for (int k = 0; k < 3; ++k) {
      added.push_back(map.AddKeyframe(MakeFrame(map.keyframes().NextId().value, 40),
                                      random.Pose(0.5, 1.0), island));
    }
    Share(map, added, 20);
    for (const KeyframeId id : added) {
      UpdateCovisibility(map, id);
    }
  }
  Map before = map.Snapshot();
  const Sim3 change = RandomSim3(random);
  MapCorrection correction = MakeCorrection(map, change);
  correction.poses.erase(correction.poses.begin(), correction.poses.begin() + 3);
  correction.loop = MapCorrection::LoopEdge{KeyframeId(1), KeyframeId(5)};
  const LandmarkId kept = map.keyframes().At(KeyframeId(1)).landmarks[0];
  const LandmarkId duplicate = map.keyframes().At(KeyframeId(5)).landmarks[0];
  const Eigen::Vector3d moved =
      map.landmarks().At(map.keyframes().At(KeyframeId(5)).landmarks[1]).position;
  correction.landmarks.push_back({.duplicate = duplicate, .kept = kept});
  ASSERT_TRUE(ApplyCorrection(map, correction, levels).is_applied);
  EXPECT_EQ(FindViolations(map), std::vector<std::string>());
  EXPECT_EQ(Islands(map).size(), 1u);
  EXPECT_EQ(map.keyframes().At(KeyframeId(5)).parent, KeyframeId(1));
  EXPECT_EQ(map.Resolve(duplicate), kept);
  for (uint32_t i = 0; i < 6; ++i) {
    const KeyframeId id(i);
    const Rigid3 pose = before.CamFromWorld(id);
    EXPECT_EQ(map.ScaleOf(id), i < 3 ? 1.0 : change.scale);
    const Eigen::Vector3d center = Inverse(pose).translation;
    const Eigen::Vector3d expected = i < 3 ? center : change * center;
    EXPECT_LT((Inverse(map.CamFromWorld(id)).translation - expected).norm(), 1e-9);
  }
  const LandmarkId other = map.keyframes().At(KeyframeId(5)).landmarks[1];
  EXPECT_LT((map.landmarks().At(other).position - change * moved).norm(), 1e-9);
}

}  // namespace
}  // namespace hullslam
