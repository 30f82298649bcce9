// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/frame_objects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "objects/constraint/misfit.h"
#include "objects/made_objects.h"
#include "support/synthetic_world.h"
#include "support/unknown_points.h"
#include "tracking/tracker.h"

namespace hullslam {
namespace {

class PoseObjectsTest : public ::testing::Test {
 protected:
  PoseObjectsTest() {
    for (size_t k = 0; k < table_.size(); ++k) {
      map_.AddObject();
    }
    for (int i = 0; i < 20; ++i) {
      const KeyframeId keyframe =
          AddObserver(map_, sensor_, CameraOnCircle(0.03 * i, 1.5, 0.6), table_);
      for (uint32_t k = 0; k < table_.size(); ++k) {
        map_.AddObservation(ObjectId(k), keyframe, k);
      }
    }
    for (uint32_t k = 0; k < table_.size(); ++k) {
      ObjectLandmark& object = map_.MutableObject(ObjectId(k));
      object.has_shape = true;
      object.state = ObjectState::kMapped;
      object.ellipsoid = table_[k].ellipsoid;
      // All of them are mapped 10 % too small. The misfit samples of the keyframes show that.
      object.ellipsoid.half_axes *= 0.9;
      const auto views = ResolveObservations(map_, object);
      object.misfit_samples = MeasureMisfit(sensor_.camera, object.ellipsoid, views);
      const MisfitSpread spread = MeasureSpread(sensor_.camera, object, views);
      object.misfit_px = spread.plain_px;
      object.compensated_px = spread.compensated_px;
    }
    for (const MadeObject& made : table_) {
      frame_.detections.push_back(Detect(made, sensor_, camera_));
    }
  }
  PoseObjects Find(bool compensate, ObjectResidual residual = ObjectResidual::kTangent) const {
    ObjectOptions options;
    options.misfit_compensation = compensate;
    options.pose.constraint.residual = residual;
    const TrackingOptions tracking;
    PoseEstimate estimate;
    estimate.cam_from_world = camera_;
    const std::vector<ObjectId> ids = FindMappedObjects(
        frame_, map_, {sensor_, tracking, options, ObjectIndex(map_, sensor_.camera)}, estimate,
        IslandId(0));
    return MakePoseObjects(map_, sensor_, frame_, camera_, ids, options);
  }
  // Expects all three objects with the original lines of their detections and the whole misfit.
  void ExpectPlain(const PoseObjects& found) const {
    ASSERT_EQ(found.objects.size(), 3u);
    for (size_t i = 0; i < 3; ++i) {
      const PoseObject& object = found.objects[i];
      EXPECT_EQ(object.misfit_px, map_.objects().At(found.ids[i]).misfit_px);
      ASSERT_EQ(object.lines.size(), object.detection->lines.size());
      for (size_t k = 0; k < object.lines.size(); ++k) {
        EXPECT_EQ(object.lines[k].line.offset, object.detection->lines[k].line.offset);
      }
    }
  }
  // Largest distance of a line from the tangent of the mapped quadric, px.
  double WorstLine(const PoseObjects& found) const {
    double worst = 0.0;
    for (const PoseObject& object : found.objects) {
      const Ellipse ellipse =
          ProjectEllipsoid(sensor_.camera.Matrix(), camera_, object.ellipsoid).value();
      for (const SilhouetteLine& line : object.lines) {
        const Eigen::Vector2d& normal = line.line.normal;
        worst = std::max(worst, std::abs(normal.dot(ellipse.center) + line.line.offset +
                                         ellipse.HalfExtent(normal)));
      }
    }
    return worst;
  }
  Sensor sensor_ = MakeObjectSensor();
  std::vector<MadeObject> table_ = MakeTable();
  Map map_;
  Rigid3 camera_ = CameraOnCircle(0.315, 1.48, 0.61);
  Frame frame_;
};

TEST_F(PoseObjectsTest, AreTheMappedOnesOfTheFrame) {
  map_.MutableObject(ObjectId(1)).state = ObjectState::kCandidate;
  const PoseObjects found = Find(false);
  EXPECT_EQ(found.ids, (std::vector<ObjectId>{ObjectId(0), ObjectId(2)}));
  ASSERT_EQ(found.objects.size(), 2u);
  EXPECT_EQ(found.objects[0].lines.size(), frame_.detections[0].lines.size());
}

TEST_F(PoseObjectsTest, CompensationReducesTheMisfitOfTheLinesAndTheirSigma) {
  const PoseObjects plain = Find(false);
  const PoseObjects compensated = Find(true);
  EXPECT_GT(WorstLine(plain), 2.0);
  EXPECT_LT(WorstLine(compensated), 0.25 * WorstLine(plain));
  for (size_t i = 0; i < plain.objects.size(); ++i) {
    EXPECT_EQ(plain.objects[i].misfit_px, map_.objects().At(plain.ids[i]).misfit_px);
    EXPECT_EQ(compensated.objects[i].misfit_px, map_.objects().At(plain.ids[i]).compensated_px);
    EXPECT_LT(compensated.objects[i].misfit_px, plain.objects[i].misfit_px);
  }
}

// The excess is found by the normal of the plane of a line, which does not depend on the position
// of the camera. So this test sees whether the lines are compensated, but not from where.
TEST_F(PoseObjectsTest, LinesOfTheRightImageAreCompensatedToo) {
  constexpr double kBaseline = 0.3;  // m
  sensor_.camera.bf = kBaseline * sensor_.camera.fx;
  const Rigid3 world_from_left = Inverse(camera_);
  const Rigid3 left_from_right{Eigen::Quaterniond::Identity(), {kBaseline, 0.0, 0.0}};
  const Rigid3 right = Inverse(world_from_left * left_from_right);
  for (size_t k = 0; k < table_.size(); ++k) {
    frame_.detections[k].right_lines = Detect(table_[k], sensor_, right).lines;
  }
  const PoseObjects found = Find(true);
  ASSERT_EQ(found.objects.size(), 3u);
  size_t compensated = 0;
  for (size_t i = 0; i < found.objects.size(); ++i) {
    const ObjectLandmark& object = map_.objects().At(found.ids[i]);
    std::vector<uint8_t> known;
    const std::vector<SilhouetteLine> expected =
        CompensateLines(sensor_.camera, right, object, found.objects[i].detection->right_lines,
                        KeyframeId(), known, ObjectOptions().misfit);
    size_t k = 0;
    for (const SilhouetteLine& line : found.objects[i].right_lines) {
      while (k < expected.size() && (known[k] == 0 || expected[k].is_one_sided)) {
        ++k;
      }
      ASSERT_LT(k, expected.size());
      EXPECT_NEAR(line.line.offset, expected[k].line.offset, 1e-9);
      ++compensated;
      ++k;
    }
  }
  EXPECT_GT(compensated, 16u);
}

TEST_F(PoseObjectsTest, IsNotDoneForResidualsWithoutLines) {
  const PoseObjects found = Find(true, ObjectResidual::kOverlap);
  ExpectPlain(found);
}

TEST_F(PoseObjectsTest, AViewFromWhereNoKeyframeSawTheObjectIsNotCompensated) {
  for (uint32_t k = 0; k < table_.size(); ++k) {
    map_.MutableObject(ObjectId(k)).misfit_samples.clear();
  }
  ExpectPlain(Find(true));
}

// One-sided lines cannot be compensated. At least half of the 16 lines must be left.
TEST_F(PoseObjectsTest, HalfOfTheLinesMustBeTwoSidedForCompensation) {
  for (const size_t one_sided : {8u, 9u}) {
    for (Detection& detection : frame_.detections) {
      for (size_t i = 0; i < one_sided; ++i) {
        detection.lines[i].is_one_sided = true;
      }
    }
    const PoseObjects found = Find(true);
    if (one_sided == 9) {
      ExpectPlain(found);
      continue;
    }
    ASSERT_EQ(found.objects.size(), 3u);
    for (const PoseObject& object : found.objects) {
      EXPECT_EQ(object.lines.size(), 8u);
      for (const SilhouetteLine& line : object.lines) {
        EXPECT_FALSE(line.is_one_sided);
      }
    }
  }
}

// The synthetic world with a ball among its points, which keyframes and frames detect. Other points
// are in front of, behind and beside it. Nothing is occluded.
class ObjectGuideTest : public testing::Test {
 protected:
  ObjectGuideTest() {
    const ObjectId id = made_.map.AddObject();
    made_.map.keyframes().ForEach(
        [&](KeyframeId keyframe, const Keyframe&) { made_.map.AddObservation(id, keyframe, 0); });
    ObjectLandmark& object = made_.map.MutableObject(id);
    object.state = ObjectState::kMapped;
    object.has_shape = true;
    object.ellipsoid = ball_.ellipsoid;
    object.misfit_px = 1.0;
  }

  double DistanceFromBall(uint32_t point) const {  // m, from its surface; negative inside
    return ball_.ellipsoid.RadialDistance(world_.points()[point]);
  }
  void AddDetection(Frame& frame, const Rigid3& cam_from_world) const {
    Detection& detection =
        frame.detections.emplace_back(Detect(ball_, world_.sensor(), cam_from_world));
    const Ellipse ellipse = ProjectedEllipse(cam_from_world);
    for (uint32_t i = 0; i < frame.features.size(); ++i) {
      const Eigen::Vector2d offset =
          frame.features.keypoints[i].undistorted.cast<double>() - ellipse.center;
      if (offset.dot(ellipse.shape.inverse() * offset) < 1.0) {
        detection.keypoints.push_back(i);
      }
    }
  }
  Ellipse ProjectedEllipse(const Rigid3& cam_from_world) const {
    return ProjectEllipsoid(world_.sensor().camera.Matrix(), cam_from_world, ball_.ellipsoid)
        .value();
  }
  const ObjectLandmark& object() const { return made_.map.objects().At(ObjectId(0)); }

  // The frame of the path without the points on the ball, and without a detection of it.
  std::shared_ptr<const Frame> FrameWithoutBall(uint32_t index) const {
    const SyntheticView view = world_.Observe(index);
    auto frame = std::make_shared<Frame>();
    frame->id = view.frame->id;
    frame->timestamp = view.frame->timestamp;
    for (uint32_t i = 0; i < view.points.size(); ++i) {
      if (DistanceFromBall(view.points[i]) > 0.2) {
        CopyKeypoint(*view.frame, i, *frame);
      }
    }
    RebuildGrid(world_.sensor(), *frame);
    return frame;
  }
  static void CopyKeypoint(const Frame& from, uint32_t i, Frame& to) {
    to.features.keypoints.push_back(from.features.keypoints[i]);
    to.features.descriptors.push_back(from.features.descriptors[i]);
    to.features.depth.push_back(from.features.depth[i]);
  }

  void Forget(LandmarkId landmark, KeyframeId keyframe) {
    const std::vector<LandmarkId>& seen = made_.map.keyframes().At(keyframe).landmarks;
    if (std::find(seen.begin(), seen.end(), landmark) != seen.end()) {
      made_.map.RemoveObservation(landmark, keyframe);
    }
  }

  // The number of landmarks found in `last`, which is frame 19. The two frames before it do not
  // show the ball.
  int Track(std::shared_ptr<const Frame> last, bool guided, int local_keyframes = 80) {
    ObjectOptions objects;
    objects.guided_matching = guided;
    objects.joint_pose = false;
    TrackingOptions options;
    options.local_keyframes = local_keyframes;
    Tracker tracker(world_.sensor(), options, objects);
    const auto snapshot = std::make_shared<const Map>(made_.map.Snapshot());
    tracker.Process(world_.Observe(0).frame, nullptr, {});
    tracker.Process(FrameWithoutBall(17), snapshot, {});
    tracker.Process(FrameWithoutBall(18), snapshot, {});
    const TrackedFrame tracked = tracker.Process(std::move(last), snapshot, {}).report.tracked;
    EXPECT_EQ(tracked.state, TrackingState::kTracked);
    const Rigid3 truth = SyntheticWorld::CamFromWorld(19);
    EXPECT_LT((tracked.cam_from_world.translation - truth.translation).norm(), 1e-5);
    return tracked.inliers;
  }

  const SyntheticWorld world_{{.points = 4000, .flipped_bits = 8}};
  const MadeObject ball_ = MakeObject("ball", {0.0, 0.0, 3.5}, {0.6, 0.6, 0.6});
  SyntheticMap made_ = MakeSyntheticMap(
      world_, {0, 4, 8, 12, 16},
      [this](Frame& frame, const Rigid3& cam_from_world) { AddDetection(frame, cam_from_world); });
  IdSet<LandmarkId> known_;
};

TEST_F(ObjectGuideTest, LandmarksBehindAnObjectAreNotOnIt) {
  const std::vector<LandmarkId> found = LandmarksOn(made_.map, object(), known_);
  EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
  int inside = 0;
  for (uint32_t point = 0; point < made_.landmarks.size(); ++point) {
    const LandmarkId id = made_.landmarks[point];
    if (id.IsValid() && DistanceFromBall(point) < -0.05) {
      ++inside;
      EXPECT_TRUE(std::binary_search(found.begin(), found.end(), id));
    } else if (id.IsValid() && DistanceFromBall(point) > 0.13) {  // the margin is 0.12 m
      EXPECT_FALSE(std::binary_search(found.begin(), found.end(), id));
    }
  }
  EXPECT_GT(inside, 10);
}

TEST_F(ObjectGuideTest, AGuideExcludesTheKeypointsOutsideTheMask) {
  const Rigid3 camera = SyntheticWorld::CamFromWorld(19);
  Frame frame = *world_.Observe(19).frame;
  AddDetection(frame, camera);
  const std::vector<ObjectGuide> guides =
      GuideByObjects(made_.map, frame, std::vector<ObjectId>{ObjectId(0)}, known_);
  ASSERT_EQ(guides.size(), 1u);
  EXPECT_EQ(guides[0].landmarks, LandmarksOn(made_.map, object(), known_));
  ASSERT_EQ(guides[0].is_outside.size(), frame.features.size());
  const Ellipse ellipse = ProjectedEllipse(camera);
  const double radius = std::sqrt(ellipse.Area() / std::numbers::pi);  // it is nearly a circle
  for (size_t i = 0; i < frame.features.size(); ++i) {
    const double distance =
        (frame.features.keypoints[i].undistorted.cast<double>() - ellipse.center).norm() - radius;
    if (distance < 3.0 || distance > 11.0) {
      EXPECT_EQ(guides[0].is_outside[i], distance > 7.0 ? 1 : 0) << distance;
    }
  }
}

TEST_F(ObjectGuideTest, DetectionsWithoutObjectGiveNoGuide) {
  Frame frame = *world_.Observe(19).frame;
  AddDetection(frame, SyntheticWorld::CamFromWorld(19));
  EXPECT_TRUE(GuideByObjects(made_.map, frame, std::vector<ObjectId>{ObjectId()}, known_).empty());
  EXPECT_TRUE(GuideByObjects(made_.map, frame, {}, known_).empty());
}

TEST_F(ObjectGuideTest, LeavesOutTheLandmarksThatAreKnown) {
  Frame frame = *world_.Observe(19).frame;
  AddDetection(frame, SyntheticWorld::CamFromWorld(19));
  const std::vector<ObjectId> objects{ObjectId(0)};
  std::vector<LandmarkId> on_ball = LandmarksOn(made_.map, object(), known_);
  known_.Insert(on_ball.front());
  on_ball.erase(on_ball.begin());
  EXPECT_EQ(GuideByObjects(made_.map, frame, objects, known_).at(0).landmarks, on_ball);
  for (const auto& [id, landmark] : made_.map.landmarks()) {
    known_.Insert(id);
  }
  EXPECT_TRUE(GuideByObjects(made_.map, frame, objects, known_).empty());
}

TEST_F(ObjectGuideTest, ChangesNothingForLandmarksOfTheLocalMap) {
  auto frame = std::make_shared<Frame>(*world_.Observe(19).frame);
  AddDetection(*frame, SyntheticWorld::CamFromWorld(19));
  EXPECT_EQ(Track(frame, true), Track(frame, false));
}

TEST_F(ObjectGuideTest, FindsLandmarksThatTheLocalMapLacks) {
  // Only the last two keyframes observe the landmarks on the ball, and the local map has only one
  // keyframe, which is another one.
  for (const LandmarkId id : LandmarksOn(made_.map, object(), known_)) {
    for (uint32_t k = 0; k < 3; ++k) {
      Forget(id, KeyframeId(k));
    }
  }
  for (uint32_t k = 0; k < 5; ++k) {
    UpdateCovisibility(made_.map, KeyframeId(k));
  }
  auto frame = std::make_shared<Frame>(*world_.Observe(19).frame);
  AddDetection(*frame, SyntheticWorld::CamFromWorld(19));
  const int forgotten = static_cast<int>(LandmarksOn(made_.map, object(), known_).size());
  ASSERT_GT(forgotten, 20);
  EXPECT_GE(Track(frame, true, 1), Track(frame, false, 1) + forgotten / 2);
}

TEST_F(ObjectGuideTest, WithoutMappedObjectsNothingChanges) {
  made_.map.MutableObject(ObjectId(0)).state = ObjectState::kCandidate;
  auto frame = std::make_shared<Frame>(*world_.Observe(19).frame);
  AddDetection(*frame, SyntheticWorld::CamFromWorld(19));
  EXPECT_EQ(Track(frame, true), Track(frame, false));
}

}  // namespace

}  // namespace hullslam
