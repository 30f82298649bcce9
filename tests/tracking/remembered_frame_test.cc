// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/remembered_frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <list>
#include <memory>
#include <utility>
#include <vector>

#include "map/keyframe_graph.h"
#include "objects/constraint/misfit.h"
#include "objects/made_objects.h"
#include "support/fisheye_camera.h"
#include "support/pose_distance.h"
#include "support/random_geometry.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

// A map of two keyframes of the synthetic world, and frame 5 between them, tracked relative to the
// first keyframe.
class RefinePosesTest : public ::testing::Test {
 protected:
  RefinePosesTest() { Make({.points = 150}); }

  void Make(const SyntheticWorldOptions& options) {
    world_ = std::make_unique<SyntheticWorld>(options);
    made_ = MakeSyntheticMap(*world_, {0, 10});
    const SyntheticView view = world_->Observe(5);
    report_.frame = view.frame;
    report_.landmarks.clear();
    for (const uint32_t point : view.points) {
      report_.landmarks.push_back(made_.landmarks[point]);
    }
    report_.tracked.frame = FrameId(5);
    report_.tracked.state = TrackingState::kTracked;
    Track(truth_);
  }
  // The remembered frame, as if tracking had found this pose.
  void Track(const Rigid3& cam_from_world) {
    report_.tracked.from_keyframe = made_.map.RelativeTo(KeyframeId(0), cam_from_world);
  }
  void Refine(const std::list<RememberedFrame>& remembered,
              std::vector<TrackedFrame>& frames) const {
    const ObjectIndex index(made_.map, world_->sensor().camera);
    RefinePoses(made_.map, {world_->sensor(), options_, objects_, index}, remembered, frames);
  }
  // The pose of the frame in the map after it was refined.
  Rigid3 Refined() const {
    std::vector<TrackedFrame> frames(1);
    frames[0].frame = FrameId(4);  // ids need not begin with 0
    frames.push_back(report_.tracked);
    const std::list<RememberedFrame> remembered = {
        Remember(report_, world_->sensor().camera, objects_)};
    Refine(remembered, frames);
    EXPECT_FALSE(frames[0].from_keyframe.has_value());
    EXPECT_EQ(frames[1].from_keyframe->reference, KeyframeId(0));
    return made_.map.CamFromWorld(*frames[1].from_keyframe);
  }
  // Moves the whole map except for the first keyframe, as a loop or an adjustment could.
  void MoveLandmarks(const Eigen::Vector3d& shift) {
    for (const auto& [id, landmark] : made_.map.landmarks()) {
      positions_.emplace_back(id, landmark.position + shift);
    }
    for (const auto& [id, position] : positions_) {
      made_.map.SetPosition(id, position);
    }
  }
  // Three mapped objects that the frame shows.
  void AddObjects() {
    auto frame = std::make_shared<Frame>(*report_.frame);
    for (const MadeObject& object : {MakeObject("cup", {-0.6, 0.2, 3.0}, {0.25, 0.15, 0.2}),
                                     MakeObject("book", {0.5, -0.4, 3.5}, {0.3, 0.2, 0.12}),
                                     MakeObject("bottle", {0.3, 0.5, 2.5}, {0.1, 0.25, 0.1})}) {
      const ObjectId id = made_.map.AddObject();
      ObjectLandmark& mapped = made_.map.MutableObject(id);
      mapped.state = ObjectState::kMapped;
      mapped.has_shape = true;
      mapped.ellipsoid = object.ellipsoid;
      report_.objects.push_back(id);
      frame->detections.push_back(Detect(object, world_->sensor(), truth_));
    }
    report_.objects.push_back(ObjectId());
    frame->detections.push_back(frame->detections.back());
    report_.frame = frame;
  }
  // Leaves only the first landmarks, as if no others had been found.
  void ForgetLandmarksAfter(size_t count) {
    size_t found = 0;
    for (LandmarkId& id : report_.landmarks) {
      found += id.IsValid() ? 1 : 0;
      if (found > count) {
        id = LandmarkId();
      }
    }
  }
  std::vector<LandmarkId> Seen() const {
    std::vector<LandmarkId> seen;
    for (const LandmarkId id : report_.landmarks) {
      if (id.IsValid()) {
        seen.push_back(id);
      }
    }
    return seen;
  }

  const Rigid3 truth_ = SyntheticWorld::CamFromWorld(5);
  const Rigid3 wrong_ = Rigid3{Eigen::Quaterniond::Identity(), {0.05, -0.03, 0.04}} * truth_;
  const TrackingOptions options_;
  const ObjectOptions objects_;
  std::unique_ptr<SyntheticWorld> world_;
  SyntheticMap made_;
  FrameReport report_;
  std::vector<std::pair<LandmarkId, Eigen::Vector3d>> positions_;
};

TEST_F(RefinePosesTest, RemembersTheLandmarksThatWereFound) {
  report_.landmarks[0] = LandmarkId();
  const RememberedFrame remembered = Remember(report_, world_->sensor().camera, objects_);
  const Frame frame = remembered.MakeFrame();
  EXPECT_EQ(frame.id, FrameId(5));
  EXPECT_EQ(remembered.points.front().landmark, Seen().front());
  const FrameFeatures& all = report_.frame->features;
  const FrameFeatures& features = frame.features;
  ASSERT_EQ(features.keypoints.size(), Seen().size());
  EXPECT_EQ(features.keypoints.back().undistorted, all.keypoints.back().undistorted);
  EXPECT_EQ(features.keypoints.back().level, all.keypoints.back().level);
  EXPECT_EQ(features.depth.back(), all.depth.back());
}

// A long run remembers thousands of frames, so each must be small.
TEST_F(RefinePosesTest, APointTakesNoMoreMemoryThanItsNumbers) {
  EXPECT_EQ(sizeof(RememberedFrame::Point), 4 * sizeof(float));
  Make({.points = 1500});
  const RememberedFrame remembered = Remember(report_, world_->sensor().camera, objects_);
  EXPECT_EQ(remembered.points.capacity(), 400u);
  EXPECT_EQ(remembered.levels.capacity(), 400u);
}

TEST_F(RefinePosesTest, RemembersAtMost400Landmarks) {
  Make({.points = 1500});
  ASSERT_GT(Seen().size(), 400u);
  const RememberedFrame remembered = Remember(report_, world_->sensor().camera, objects_);
  EXPECT_EQ(remembered.points.size(), 400u);
  EXPECT_EQ(remembered.points.front().landmark, Seen().front());
  Track(wrong_);
  EXPECT_LT(Distance(Refined(), truth_), 1e-4);
}

// A relative pose alone would follow the reference keyframe, and not the map around the frame.
TEST_F(RefinePosesTest, AFrameFollowsItsLandmarks) {
  const Eigen::Vector3d shift(0.04, 0.02, -0.03);
  MoveLandmarks(shift);
  const Rigid3 moved = truth_ * Rigid3{Eigen::Quaterniond::Identity(), -shift};
  EXPECT_GT(Distance(made_.map.CamFromWorld(*report_.tracked.from_keyframe), moved), 0.05);
  EXPECT_LT(Distance(Refined(), moved), 1e-4);
}

TEST_F(RefinePosesTest, MonocularToo) {
  Make({.points = 150, .depth_share = 0.0});
  Track(wrong_);
  EXPECT_LT(Distance(Refined(), truth_), 1e-4);
}

// The landmarks have become 5 % nearer. Pixels do not show this, but depth does.
TEST_F(RefinePosesTest, DepthConstrainsThePose) {
  const auto error_of = [&](double depth_share) {
    Make({.points = 150, .depth_share = depth_share});
    for (const LandmarkId id : Seen()) {
      const Eigen::Vector3d in_camera = truth_ * made_.map.landmarks().At(id).position;
      made_.map.SetPosition(id, Inverse(truth_) * Eigen::Vector3d(0.95 * in_camera));
    }
    return Distance(Refined(), truth_);
  };
  EXPECT_LT(error_of(0.0), 1e-4);
  EXPECT_GT(error_of(1.0), 5e-4);
}

TEST_F(RefinePosesTest, KnowsWhichLandmarksAreOneNow) {
  Track(wrong_);
  for (const LandmarkId id : Seen()) {
    const Landmark landmark = made_.map.landmarks().At(id);
    const LandmarkId other = made_.map.AddLandmark(landmark.position, KeyframeId(0));
    made_.map.ReplaceLandmark(id, other);
  }
  EXPECT_LT(Distance(Refined(), truth_), 1e-4);
}

TEST_F(RefinePosesTest, KeepsThePoseIfTheLandmarksAreGone) {
  Track(wrong_);
  const std::vector<LandmarkId> seen = Seen();
  ASSERT_GT(seen.size(), 80u);
  size_t left = seen.size();
  const auto keep = [&](size_t count) {
    while (left > count) {
      made_.map.EraseLandmark(seen[--left]);
    }
  };
  keep(seen.size() / 2 + 1);
  EXPECT_LT(Distance(Refined(), truth_), 1e-4);
  keep(seen.size() / 2 - 1);
  EXPECT_LT(Distance(Refined(), wrong_), 1e-12);
}

TEST_F(RefinePosesTest, KeepsThePoseIfThereWereFewLandmarks) {
  Track(wrong_);
  ForgetLandmarksAfter(29);
  EXPECT_LT(Distance(Refined(), wrong_), 1e-12);
}

TEST_F(RefinePosesTest, KeepsThePoseIfTheLandmarksContradictIt) {
  Track(wrong_);
  RandomGeometry random(3);
  for (const LandmarkId id : Seen()) {
    made_.map.SetPosition(id, made_.map.landmarks().At(id).position + random.Vector(0.5));
  }
  EXPECT_LT(Distance(Refined(), wrong_), 1e-12);
}

TEST_F(RefinePosesTest, RemembersTheDetectionsOfMappedObjects) {
  AddObjects();
  auto frame = std::make_shared<Frame>(*report_.frame);
  frame->detections[1].embedding = {0.6f, 0.8f};
  report_.frame = frame;
  const RememberedFrame remembered = Remember(report_, world_->sensor().camera, objects_);
  ASSERT_EQ(remembered.detections.size(), 3u);
  EXPECT_EQ(remembered.objects.size(), 3u);
  const Detection& seen = report_.frame->detections[1];
  const Detection& kept = remembered.detections[1];
  EXPECT_EQ(kept.lines.size(), seen.lines.size());
  EXPECT_TRUE(kept.hull.empty());
  EXPECT_TRUE(kept.contour.empty());
  EXPECT_TRUE(kept.points.empty());
  EXPECT_EQ(kept.embedding.capacity(), 0u);
  EXPECT_EQ(kept.keypoints.capacity(), 0u);
  ObjectOptions options;
  options.pose.constraint.residual = ObjectResidual::kAlgebraicPoint;  // needs the contour
  EXPECT_FALSE(Remember(report_, world_->sensor().camera, options).detections[1].contour.empty());
  options.joint_pose = false;
  EXPECT_TRUE(Remember(report_, world_->sensor().camera, options).detections.empty());
}

// The lines of a fisheye lens count in pixels of the raw image, which follow from where they touch
// the hull.
TEST(RememberedFrame, HasTheLinesOfTheFrameInTheRawImage) {
  for (const PinholeCamera& camera : {SyntheticSensor().camera, FisheyeCamera()}) {
    Sensor sensor = SyntheticSensor();
    sensor.camera = camera;
    auto frame = std::make_shared<Frame>();
    frame->detections = {
        Detect(MakeObject("cup", {1.4, -0.8, 1.5}, {0.25, 0.15, 0.2}), sensor, Rigid3())};
    FrameReport report;
    report.frame = frame;
    report.objects = {ObjectId(0)};
    const RememberedFrame remembered = Remember(report, camera, ObjectOptions());
    ASSERT_EQ(remembered.detections.size(), 1u);
    const auto raw_lines = [&](const Detection& detection) {
      return ScaleToRaw(camera, detection, detection.lines);
    };
    const std::vector<SilhouetteLine> expected = raw_lines(frame->detections[0]);
    const std::vector<SilhouetteLine> lines = raw_lines(remembered.detections[0]);
    ASSERT_EQ(lines.size(), expected.size());
    for (size_t i = 0; i < lines.size(); ++i) {
      EXPECT_EQ(lines[i].line.Homogeneous(), expected[i].line.Homogeneous());
    }
    EXPECT_NE(camera.IsFisheye(), std::abs(lines[0].line.normal.norm() - 1.0) < 0.1);
  }
}

// An object counts as five landmarks.
TEST_F(RefinePosesTest, ObjectsTakePart) {
  AddObjects();
  ForgetLandmarksAfter(20);
  Track(wrong_);
  EXPECT_LT(Distance(Refined(), truth_), 1e-3);
  const ObjectId other = made_.map.AddObject();
  made_.map.MutableObject(other) = made_.map.objects().At(report_.objects[0]);
  made_.map.ReplaceObject(report_.objects[0], other);
  EXPECT_LT(Distance(Refined(), truth_), 1e-3);
  made_.map.MutableObject(other).state = ObjectState::kCandidate;
  made_.map.EraseObject(report_.objects[1]);
  EXPECT_LT(Distance(Refined(), wrong_), 1e-12);
}

// Since it was culled, nothing has adjusted its pose.
TEST_F(RefinePosesTest, TheFrameOfACulledKeyframeIsRefinedToo) {
  auto frame = std::make_shared<Frame>(*report_.frame);
  frame->id = FrameId(15);  // later than the keyframes of the map
  report_.frame = frame;
  report_.tracked.frame = frame->id;
  const KeyframeId culled = made_.map.AddKeyframe(frame, wrong_);
  SetParent(made_.map, culled, KeyframeId(0));
  made_.map.CullKeyframe(culled);
  ASSERT_EQ(made_.map.KeyframeOfFrame(report_.tracked.frame), culled);
  std::vector<TrackedFrame> frames = {report_.tracked};
  const std::list<RememberedFrame> remembered = {
      Remember(report_, world_->sensor().camera, objects_)};
  Refine(remembered, frames);
  ASSERT_EQ(frames[0].from_keyframe->reference, culled);
  EXPECT_LT(Distance(made_.map.CamFromWorld(*frames[0].from_keyframe), truth_), 1e-4);

  // Without enough landmarks it keeps the pose of the keyframe and not that of tracking.
  ForgetLandmarksAfter(29);
  frames = {report_.tracked};
  Refine({Remember(report_, world_->sensor().camera, objects_)}, frames);
  EXPECT_LT(Distance(made_.map.CamFromWorld(*frames[0].from_keyframe), wrong_), 1e-12);
}

TEST_F(RefinePosesTest, OnceItIsCancelledTheOtherFramesKeepTheirPoses) {
  Track(wrong_);
  std::vector<TrackedFrame> frames(2, report_.tracked);
  frames[1].frame = FrameId(6);
  std::list<RememberedFrame> remembered(2, Remember(report_, world_->sensor().camera, objects_));
  remembered.back().id = FrameId(6);
  Cancellation cancellation;
  std::vector<int> progress;
  const ObjectIndex index(made_.map, world_->sensor().camera);
  RefinePoses(made_.map, {world_->sensor(), options_, objects_, index}, remembered, frames,
              &cancellation, [&](int done, int most) {
                progress.insert(progress.end(), {done, most});
                cancellation.Request();
              });
  EXPECT_EQ(progress, (std::vector<int>{1, 2}));
  EXPECT_LT(Distance(made_.map.CamFromWorld(*frames[0].from_keyframe), truth_), 1e-4);
  EXPECT_LT(Distance(made_.map.CamFromWorld(*frames[1].from_keyframe), wrong_), 1e-12);
}

// The memory of a run is bounded, and every frame is refined once.
TEST_F(RefinePosesTest, TheOldestFramesAreRefinedAndForgotten) {
  constexpr size_t kMost = 3;
  Track(wrong_);
  const ObjectIndex index(made_.map, world_->sensor().camera);
  const TrackingContext context{world_->sensor(), options_, objects_, index};
  std::list<RememberedFrame> remembered;
  std::vector<TrackedFrame> frames;
  const auto error_of = [&](const TrackedFrame& frame) {
    return Distance(made_.map.CamFromWorld(*frame.from_keyframe), truth_);
  };
  for (uint32_t i = 0; i < 8; ++i) {
    report_.tracked.frame = FrameId(20 + i);
    frames.push_back(report_.tracked);
    remembered.push_back(Remember(report_, world_->sensor().camera, objects_));
    RefineOldest(made_.map, context, kMost, remembered, frames);
    ASSERT_EQ(remembered.size(), std::min<size_t>(i + 1, kMost));
    EXPECT_EQ(remembered.back().id, report_.tracked.frame);
  }
  for (size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(error_of(frames[i]) < 1e-4, i < frames.size() - kMost) << i;
  }
  Refine(remembered, frames);
  for (const TrackedFrame& frame : frames) {
    EXPECT_LT(error_of(frame), 1e-4);
  }
}

TEST_F(RefinePosesTest, AFrameWithoutAPoseStaysWithoutOne) {
  report_.tracked.from_keyframe.reset();
  std::vector<TrackedFrame> frames = {report_.tracked};
  const std::list<RememberedFrame> remembered = {
      Remember(report_, world_->sensor().camera, objects_)};
  Refine(remembered, frames);
  EXPECT_FALSE(frames[0].from_keyframe.has_value());
}

}  // namespace
}  // namespace hullslam
