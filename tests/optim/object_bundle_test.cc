// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "map/made_map.h"
#include "map_files/invariants.h"
#include "objects/made_objects.h"
#include "optim/bundle_adjustment.h"
#include "support/captured_log.h"
#include "support/pose_distance.h"
#include "support/random_geometry.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

// The largest of the distance of the centres and the differences of the half extents along many
// directions, relative to the size. It does not depend on the order of the axes.
double ShapeError(const Ellipsoid& a, const Ellipsoid& b) {
  const auto extent = [](const Ellipsoid& ellipsoid, const Eigen::Vector3d& direction) {
    return (ellipsoid.world_from_object.rotation.conjugate() * direction)
        .cwiseProduct(ellipsoid.half_axes)
        .norm();
  };
  RandomGeometry random(7);
  double worst = (a.world_from_object.translation - b.world_from_object.translation).norm();
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d direction = random.Vector(1.0).normalized();
    worst = std::max(worst, std::abs(extent(a, direction) - extent(b, direction)));
  }
  return worst / std::cbrt(b.half_axes.prod());
}

// A map of the synthetic world with three objects that all keyframes see. The first two keyframes
// are fixed.
class ObjectBundle : public ::testing::Test {
 protected:
  static constexpr BundleOptions kPrecise{
      .robust_iterations = 20, .final_iterations = 20, .function_tolerance = 1e-14};

  ObjectBundle() { Make({.points = 300, .depth_share = 0.7}); }

  void Make(const SyntheticWorldOptions& options) {
    world_.emplace(options);
    objects_ = {MakeObject("cup", {-0.6, 0.2, 3.0}, {0.25, 0.15, 0.2}, 0.3),
                MakeObject("book", {0.5, -0.4, 3.5}, {0.3, 0.2, 0.12}, 1.0),
                MakeObject("bottle", {0.3, 0.5, 2.5}, {0.1, 0.25, 0.1})};
    if (couch_) {
      objects_[1] = *couch_;
    }
    made_ = MakeSyntheticMap(
        *world_, {0, 10, 20, 30, 40, 50}, [this](Frame& frame, const Rigid3& cam_from_world) {
          for (size_t i = 0; i < objects_.size(); ++i) {
            frame.detections.push_back(
                Detect(SeenPart(objects_[i], cam_from_world), world_->sensor(), cam_from_world));
            frame.detections.back().primitive = primitive_;
            Disturb(frame, frame.detections.back());
            if (static_cast<int>(i) == object_without_depth_) {
              frame.detections.back().points.clear();
            }
          }
        });
    ids_.clear();
    for (uint32_t i = 0; i < objects_.size(); ++i) {
      ids_.push_back(made_.map.AddObject());
      for (uint32_t k = 0; k < made_.views.size(); ++k) {
        made_.map.AddObservation(ids_.back(), KeyframeId(k), i);
      }
      ObjectLandmark& object = made_.map.MutableObject(ids_.back());
      object.state = ObjectState::kMapped;
      object.has_shape = true;
      object.ellipsoid = objects_[i].ellipsoid;
      object.start = object.ellipsoid;
    }
  }
  // If an object is not wholly in front of the camera, only its far end is seen.
  MadeObject SeenPart(const MadeObject& object, const Rigid3& cam_from_world) const {
    MadeObject part = object;
    while (!ProjectEllipsoid(world_->sensor().camera.Matrix(), cam_from_world, part.ellipsoid)) {
      part.ellipsoid.half_axes.z() -= 0.05;
      part.ellipsoid.world_from_object.translation.z() += 0.05;
    }
    return part;
  }
  // Shifts the lines of frame shifted_frame_ by 40 px and adds noise to all lines.
  void Disturb(const Frame& frame, Detection& detection) {
    const double shift = static_cast<int>(frame.id.value) == shifted_frame_ ? 40.0 : 0.0;
    for (SilhouetteLine& line : detection.lines) {
      line.line.offset -= shift * line.line.normal.x();
      line.line.offset += random_.Number(-line_noise_, line_noise_);
    }
  }
  void PerturbPoses(double angle, double distance) {
    for (uint32_t i = 2; i < made_.views.size(); ++i) {
      const Rigid3& pose = made_.map.keyframes().At(KeyframeId(i)).cam_from_world;
      made_.map.SetPose(KeyframeId(i), random_.Pose(angle, distance) * pose);
    }
  }
  void PerturbObjects(double relative) {
    for (const ObjectId id : ids_) {
      ObjectLandmark& object = made_.map.MutableObject(id);
      object.ellipsoid.world_from_object.translation += random_.Vector(0.1 * relative);
      object.ellipsoid.half_axes.array() *= 1.0 + random_.Vector(relative).array();
      object.start = object.ellipsoid;
    }
  }
  BundleWindow Window() const {
    BundleWindow window;
    window.fixed = {KeyframeId(0), KeyframeId(1)};
    for (uint32_t i = 2; i < made_.views.size(); ++i) {
      window.moving.push_back(KeyframeId(i));
    }
    for (const LandmarkId id : made_.landmarks) {
      if (id.IsValid()) {
        window.landmarks.push_back(id);
      }
    }
    window.objects = ids_;
    return window;
  }
  BundleWindow PointsOnly() const {
    BundleWindow window = Window();
    window.objects.clear();
    return window;
  }
  BundleResult Adjust(const BundleWindow& window, const BundleOptions& options = kPrecise) const {
    return AdjustBundle(made_.map, world_->sensor(), window, options, nullptr);
  }
  static double MeanPoseError(const BundleResult& result) {
    double sum = 0.0;
    for (const auto& [id, pose] : result.poses) {
      sum += Distance(pose, SyntheticWorld::CamFromWorld(10.0 * id.value));
    }
    return sum / static_cast<double>(result.poses.size());
  }
  double MeanShapeError(const BundleResult& result) const {
    double sum = 0.0;
    for (size_t i = 0; i < result.ellipsoids.size(); ++i) {
      sum += ShapeError(result.ellipsoids[i].second, objects_[i].ellipsoid);
    }
    return sum / static_cast<double>(result.ellipsoids.size());
  }
  double MeanShapeErrorBefore() const {
    double sum = 0.0;
    for (size_t i = 0; i < ids_.size(); ++i) {
      sum += ShapeError(made_.map.objects().At(ids_[i]).ellipsoid, objects_[i].ellipsoid);
    }
    return sum / static_cast<double>(ids_.size());
  }

  RandomGeometry random_{1};
  int shifted_frame_ = -1;
  double line_noise_ = 0.0;        // px
  int object_without_depth_ = -1;  // index of an object
  ObjectPrimitive primitive_ = ObjectPrimitive::kSupport;
  std::optional<SyntheticWorld> world_;
  std::vector<MadeObject> objects_;
  std::optional<MadeObject> couch_;  // replaces the book
  SyntheticMap made_;
  std::vector<ObjectId> ids_;
};

TEST_F(ObjectBundle, WindowsContainTheMappedObjects) {
  made_.map.MutableObject(ids_[1]).state = ObjectState::kCandidate;
  const std::vector<ObjectId> mapped = {ids_[0], ids_[2]};
  const KeyframeId last(5);
  EXPECT_EQ(LocalWindow(made_.map, last, 20, 40, WindowObjects::kMapped).objects, mapped);
  EXPECT_EQ(GlobalWindow(made_.map, IslandId(0), WindowObjects::kMapped).objects, mapped);
  EXPECT_TRUE(LocalWindow(made_.map, last, 20, 40).objects.empty());
  for (uint32_t k = 0; k < 6; ++k) {
    made_.map.RemoveObservation(ids_[0], KeyframeId(k));
  }
  EXPECT_EQ(LocalWindow(made_.map, last, 20, 40, WindowObjects::kMapped).objects,
            std::vector<ObjectId>{ids_[2]});
}

TEST_F(ObjectBundle, RecoversPosesAndShapes) {
  PerturbPoses(0.01, 0.02);
  PerturbObjects(0.2);
  const double before = MeanShapeErrorBefore();
  const BundleResult result = Adjust(Window());
  ASSERT_TRUE(result.is_usable);
  ASSERT_EQ(result.ellipsoids.size(), 3u);
  EXPECT_TRUE(result.failed_objects.empty());
  EXPECT_LT(MeanPoseError(result), 1e-3);
  // The remaining error comes from the prior, whose shapes are wrong, and from the depth points,
  // which lie on the visible half of the surface.
  EXPECT_GT(before, 0.15);
  EXPECT_LT(MeanShapeError(result), 0.25 * before);
}

// Only the root is fixed.
TEST_F(ObjectBundle, OfTheWholeMapImprovesPosesAndShapes) {
  PerturbPoses(0.01, 0.02);
  PerturbObjects(0.2);
  const double before = MeanShapeErrorBefore();
  const BundleWindow window = GlobalWindow(made_.map, IslandId(0), WindowObjects::kMapped);
  ASSERT_EQ(window.moving.size(), 5u);
  const BundleResult result = Adjust(window);
  ASSERT_TRUE(result.is_usable);
  ASSERT_EQ(result.ellipsoids.size(), 3u);
  EXPECT_LT(MeanPoseError(result), 1e-3);
  EXPECT_LT(MeanShapeError(result), 0.25 * before);
}

// The outlines are weak compared with the prior, and the objects start two sizes away from their
// true positions.
TEST_F(ObjectBundle, OfTheWholeMapDoesNotHoldObjectsBack) {
  for (const ObjectId id : ids_) {
    ObjectLandmark& object = made_.map.MutableObject(id);
    object.ellipsoid.world_from_object.translation.x() +=
        2.0 * std::cbrt(object.ellipsoid.half_axes.prod());
    object.misfit_px = 40.0;
  }
  const double of_whole_map = MeanShapeError(Adjust(Window(), kPrecise.ForWholeMap()));
  EXPECT_LT(of_whole_map, 0.1);
  EXPECT_GT(MeanShapeError(Adjust(Window())), 5.0 * of_whole_map);
}

// The scale is wrong by a fifth. Points alone need two iterations per round to correct it, and with
// objects it takes at most one more.
TEST_F(ObjectBundle, OfTheWholeMapFollowsAChangeOfItsScale) {
  BundleOptions options = kPrecise.ForWholeMap();
  options.robust_iterations = options.final_iterations = 3;
  options.max_dense = 0;  // as in a large map
  constexpr int kTrials = 10;
  double points_alone = 0.0;
  double with_objects = 0.0;
  size_t failed = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    Make({.points = 300, .pixel_noise = 0.3});
    for (uint32_t i = 2; i < made_.views.size(); ++i) {
      Rigid3 pose = made_.map.keyframes().At(KeyframeId(i)).cam_from_world;
      pose.translation *= 0.8;
      made_.map.SetPose(KeyframeId(i), pose);
    }
    PerturbObjects(0.4);
    points_alone += MeanPoseError(Adjust(GlobalWindow(made_.map, IslandId(0)), options));
    const BundleResult all =
        Adjust(GlobalWindow(made_.map, IslandId(0), WindowObjects::kMapped), options);
    with_objects += MeanPoseError(all);
    failed += all.failed_objects.size();
  }
  EXPECT_LT(with_objects, 1.5 * points_alone);
  EXPECT_LE(failed, 3u) << "of 30";
}

TEST_F(ObjectBundle, StaysAtTheTruth) {
  const BundleResult result = Adjust(Window());
  ASSERT_TRUE(result.is_usable);
  EXPECT_LT(MeanPoseError(result), 1e-5);
  EXPECT_LT(MeanShapeError(result), 1e-4);
  EXPECT_TRUE(result.outliers.empty());
}

TEST_F(ObjectBundle, OtherResidualsImproveShapesToo) {
  for (const auto& [residual, primitive] :
       {std::pair(ObjectResidual::kAlgebraicPlane, ObjectPrimitive::kSupport),
        {ObjectResidual::kRelativePlane, ObjectPrimitive::kSupport},
        {ObjectResidual::kAlgebraicPoint, ObjectPrimitive::kContour},
        {ObjectResidual::kOverlap, ObjectPrimitive::kHull}}) {
    BundleOptions options = kPrecise;
    options.objects.constraint.residual = residual;
    primitive_ = primitive;
    Make({.points = 300, .depth_share = 0.7});
    PerturbObjects(0.2);
    const double before = MeanShapeErrorBefore();
    const BundleResult result = Adjust(Window(), options);
    ASSERT_TRUE(result.is_usable);
    EXPECT_LT(MeanShapeError(result), 0.5 * before) << NameOf(residual);
    EXPECT_LT(MeanPoseError(result), 0.01) << NameOf(residual);
  }
}

// Detections of objects that are not in the window do not change any bit of the result.
TEST_F(ObjectBundle, WithoutObjectsItAdjustsPointsOnly) {
  PerturbPoses(0.01, 0.02);
  const BundleResult result = Adjust(PointsOnly());
  for (const ObjectId id : ids_) {
    made_.map.EraseObject(id);
  }
  const BundleResult expected = Adjust(PointsOnly());
  EXPECT_EQ(result.positions, expected.positions);
  EXPECT_EQ(result.residuals, expected.residuals);
  EXPECT_TRUE(result.ellipsoids.empty());
}

TEST_F(ObjectBundle, SameInputGivesTheSameBits) {
  PerturbPoses(0.01, 0.02);
  PerturbObjects(0.2);
  const BundleResult first = Adjust(Window(), {});
  const BundleResult second = Adjust(Window(), {});
  EXPECT_EQ(first.positions, second.positions);
  ASSERT_EQ(first.ellipsoids.size(), second.ellipsoids.size());
  for (size_t i = 0; i < first.ellipsoids.size(); ++i) {
    EXPECT_EQ(first.ellipsoids[i].second.half_axes, second.ellipsoids[i].second.half_axes);
    EXPECT_EQ(first.ellipsoids[i].second.world_from_object.translation,
              second.ellipsoids[i].second.world_from_object.translation);
  }
}

// The map has only a dozen points, with noise, and outlines with noise.
TEST_F(ObjectBundle, ObjectsHelpWherePointsAreFew) {
  double with = 0.0;
  double without = 0.0;
  line_noise_ = 3.0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    Make({.points = 12, .pixel_noise = 1.0, .seed = seed});
    PerturbPoses(0.005, 0.01);
    with += MeanPoseError(Adjust(Window()));
    without += MeanPoseError(Adjust(PointsOnly()));
  }
  EXPECT_LT(with, 0.9 * without);
}

// In one keyframe the outlines of all objects are shifted by 40 px.
TEST_F(ObjectBundle, AWrongFrameDoesNotHarmManyPoints) {
  double with = 0.0;
  double without = 0.0;
  shifted_frame_ = 30;
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    Make({.points = 300, .pixel_noise = 1.0, .seed = seed});
    const BundleResult result = Adjust(Window());
    EXPECT_LT(MeanShapeError(result), 0.1);
    with += MeanPoseError(result);
    without += MeanPoseError(Adjust(PointsOnly()));
  }
  EXPECT_LT(with, 1.05 * without);
}

// Silhouettes alone do not constrain all of a quadric, so objects without depth have their own
// prior.
TEST_F(ObjectBundle, AnObjectWithoutDepthHasAPriorOfItsOwn) {
  object_without_depth_ = 1;
  Make({.points = 300, .depth_share = 0.7});
  PerturbObjects(0.2);
  BundleOptions options = kPrecise;
  options.objects.constraint.prior_without_depth = {
      .log_axes = 1e-4, .center = 1e-4, .rotation = 1e-4};
  const BundleResult result = Adjust(Window(), options);
  ASSERT_EQ(result.ellipsoids.size(), 3u);
  for (const auto& [id, ellipsoid] : result.ellipsoids) {
    const double moved = ShapeError(ellipsoid, made_.map.objects().At(id).start);
    if (id == ids_[1]) {
      EXPECT_LT(moved, 0.01);
    } else {
      EXPECT_GT(moved, 0.05);
    }
  }
}

// Keyframes outside of the window constrain the objects, although they are fixed.
TEST_F(ObjectBundle, OuterViewsConstrainObjects) {
  BundleWindow window = Window();
  window.moving = {KeyframeId(5)};
  window.fixed = {KeyframeId(4)};
  BundleOptions options = kPrecise;
  options.objects.max_outer_views = 0;
  const BundleResult none = Adjust(window, options);
  options.objects.max_outer_views = 2;
  const BundleResult two = Adjust(window, options);
  options.objects.max_outer_views = 10;
  const BundleResult all = Adjust(window, options);
  EXPECT_EQ(two.residuals - none.residuals, 3 * 2 * 2);  // per observation: outline and depth
  EXPECT_EQ(all.residuals - none.residuals, 3 * 4 * 2);
  EXPECT_EQ(all.poses.size(), 1u);
}

// An object starts as the side that was seen first, so its start is nearer to the camera than it
// is.
TEST_F(ObjectBundle, TheStartOfAnObjectHasNoInfluence) {
  PerturbPoses(0.01, 0.02);
  const BundleResult expected = Adjust(Window());
  for (const ObjectId id : ids_) {
    ObjectLandmark& object = made_.map.MutableObject(id);
    object.start.world_from_object.translation.z() -= 0.2;
    object.start.half_axes.z() *= 0.3;
  }
  const BundleResult result = Adjust(Window());
  for (size_t i = 0; i < expected.poses.size(); ++i) {
    EXPECT_EQ(Distance(result.poses[i].second, expected.poses[i].second), 0.0);
  }
  EXPECT_EQ(MeanShapeError(result), MeanShapeError(expected));
}

// A couch is in front of the first camera and reaches beside the last ones, in which it has no
// projected ellipse. This must not stop all poses.
TEST_F(ObjectBundle, AnObjectThatReachesACameraDoesNotHoldThePoses) {
  const MadeObject couch = MakeObject("couch", {1.2, 0.3, 1.6}, {0.3, 0.2, 1.4});
  couch_ = couch;
  Make({.points = 300, .depth_share = 0.7});
  const KeyframeId last(5);
  ObjectLandmark& object = made_.map.MutableObject(ids_[1]);
  object.ellipsoid = SeenPart(couch, made_.map.keyframes().At(last).cam_from_world).ellipsoid;
  PerturbPoses(0.01, 0.02);
  const BundleResult result = Adjust(Window());
  ASSERT_TRUE(result.is_usable);
  EXPECT_LT(MeanPoseError(result), 1e-3);
  EXPECT_EQ(result.failed_objects, std::vector<ObjectId>{ids_[1]});
  EXPECT_EQ(result.ellipsoids.size(), 2u);
}

TEST_F(ObjectBundle, AShapeThatChangesTooMuchIsNotWritten) {
  const Eigen::Vector3d before = 5.0 * objects_[1].ellipsoid.half_axes;
  made_.map.MutableObject(ids_[1]).ellipsoid.half_axes = before;
  BundleOptions options = kPrecise;
  options.objects.constraint.loss_scale = 1e3;  // distant outlines are not outliers
  options.objects.constraint.prior.log_axes = 1e3;
  const BundleResult result = Adjust(Window(), options);
  ASSERT_TRUE(result.is_usable);
  EXPECT_EQ(result.failed_objects, std::vector<ObjectId>{ids_[1]});
  ASSERT_EQ(result.ellipsoids.size(), 2u);
  EXPECT_LT(MeanPoseError(result), 1e-5);
  ApplyBundle(made_.map, result, world_->sensor().levels);
  EXPECT_EQ(made_.map.objects().At(ids_[1]).ellipsoid.half_axes, before);
}

// Ceres fails at a value that is not finite. The points are adjusted nevertheless.
TEST_F(ObjectBundle, AnObjectThatIsNotFiniteDoesNotStopThePoints) {
  PerturbPoses(0.01, 0.02);
  const BundleResult expected = Adjust(PointsOnly());
  made_.map.MutableObject(ids_[0]).ellipsoid.half_axes.x() =
      std::numeric_limits<double>::quiet_NaN();
  const CapturedLog log;
  const BundleResult result = Adjust(Window());
  ASSERT_TRUE(result.is_usable);
  EXPECT_EQ(result.failed_objects, ids_);
  EXPECT_TRUE(result.ellipsoids.empty());
  EXPECT_EQ(result.positions, expected.positions);
  EXPECT_NE(log.text().find("bundle adjustment of"), std::string::npos) << log.text();
  EXPECT_NE(log.text().find("failed"), std::string::npos) << log.text();
}

TEST_F(ObjectBundle, CancelledAtOnceItKeepsTheShapes) {
  PerturbObjects(0.2);
  Cancellation cancellation;
  cancellation.Request();
  const BundleResult result =
      AdjustBundle(made_.map, world_->sensor(), Window(), kPrecise, &cancellation);
  ASSERT_EQ(result.ellipsoids.size(), 3u);
  for (const auto& [id, ellipsoid] : result.ellipsoids) {
    EXPECT_LT(ShapeError(ellipsoid, made_.map.objects().At(id).ellipsoid), 1e-12);
  }
}

TEST_F(ObjectBundle, ApplyingWritesShapesAndSkipsObjectsThatNoLongerExist) {
  PerturbObjects(0.2);
  const BundleResult result = Adjust(Window());
  const std::string before = Dump(made_.map);
  made_.map.EraseObject(ids_[2]);
  ApplyBundle(made_.map, result, world_->sensor().levels);
  EXPECT_EQ(FindViolations(made_.map), std::vector<std::string>());
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(made_.map.objects().At(ids_[i]).ellipsoid.half_axes,
              result.ellipsoids[i].second.half_axes);
  }
  EXPECT_FALSE(made_.map.objects().Contains(ids_[2]));
}

// A misfit of 1.5 px counts twice, so it is the same as a sigma of 3 px more.
TEST_F(ObjectBundle, TheMisfitOfAnObjectCountsTwiceInTheSigmaOfItsLines) {
  line_noise_ = 3.0;
  Make({.points = 50, .depth_share = 0.7});
  PerturbObjects(0.05);
  BundleOptions options = kPrecise;
  const double plain_sigma = options.objects.constraint.sigma_px;
  const auto adjust = [&](double sigma_px, double misfit_px) {
    for (const ObjectId id : ids_) {
      made_.map.MutableObject(id).misfit_px = misfit_px;
    }
    options.objects.constraint.sigma_px = sigma_px;
    return Adjust(Window(), options).ellipsoids;
  };
  const auto by_misfit = adjust(plain_sigma, 1.5);
  const auto by_sigma = adjust(std::hypot(plain_sigma, 3.0), 0.0);
  const auto by_half = adjust(std::hypot(plain_sigma, 1.5), 0.0);
  ASSERT_EQ(by_misfit.size(), ids_.size());
  ASSERT_EQ(by_sigma.size(), ids_.size());
  ASSERT_EQ(by_half.size(), ids_.size());
  for (size_t i = 0; i < ids_.size(); ++i) {
    EXPECT_LT(ShapeError(by_misfit[i].second, by_sigma[i].second), 1e-9);
    EXPECT_GT(ShapeError(by_half[i].second, by_sigma[i].second), 1e-5);
  }
}

// With a sparse system of the poses, as in a large map, and with a dense one.
TEST_F(ObjectBundle, ALockedObjectStaysAndTheOthersAreAdjusted) {
  PerturbPoses(0.01, 0.02);
  PerturbObjects(0.2);
  ObjectLandmark& locked = made_.map.MutableObject(ids_[0]);
  locked.is_locked = true;
  locked.ellipsoid = objects_[0].ellipsoid;
  const double before =
      ShapeError(made_.map.objects().At(ids_[1]).ellipsoid, objects_[1].ellipsoid);
  for (const size_t max_dense : {size_t{0}, kPrecise.max_dense}) {
    BundleOptions options = kPrecise;
    options.max_dense = max_dense;
    const BundleResult result = Adjust(Window(), options);
    ASSERT_TRUE(result.is_usable);
    ASSERT_EQ(result.ellipsoids.size(), 2u);
    EXPECT_EQ(result.ellipsoids[0].first, ids_[1]);
    EXPECT_LT(ShapeError(result.ellipsoids[0].second, objects_[1].ellipsoid), 0.5 * before);
    EXPECT_LT(MeanPoseError(result), 1e-3);
    EXPECT_TRUE(result.failed_objects.empty());
  }
}

// All poses of a monocular map are too near to the root. Locked objects have the true size.
TEST_F(ObjectBundle, LockedObjectsHoldTheScaleOfAMonocularMap) {
  Make({.points = 300, .depth_share = 0.0});
  Sensor sensor = world_->sensor();
  sensor.kind = SensorKind::kMonocular;
  for (const bool is_locked : {false, true}) {
    for (uint32_t i = 1; i < made_.views.size(); ++i) {
      Rigid3 pose = SyntheticWorld::CamFromWorld(10.0 * i);
      pose.translation *= 0.95;
      made_.map.SetPose(KeyframeId(i), pose);
    }
    for (const ObjectId id : ids_) {
      made_.map.MutableObject(id).is_locked = is_locked;
    }
    BundleWindow window = Window();
    window.fixed = {KeyframeId(0)};
    window.moving.insert(window.moving.begin(), KeyframeId(1));
    for (const size_t max_dense : {size_t{0}, kPrecise.max_dense}) {
      BundleOptions options = kPrecise.ForWholeMap();
      options.max_dense = max_dense;
      const BundleResult result = AdjustBundle(made_.map, sensor, window, options, nullptr);
      ASSERT_TRUE(result.is_usable);
      EXPECT_EQ(result.ellipsoids.size(), is_locked ? 0u : 3u);
      EXPECT_EQ(MeanPoseError(result) < 1e-3, is_locked) << MeanPoseError(result);
    }
  }
}

}  // namespace
}  // namespace hullslam
