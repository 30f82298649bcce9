// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/repeated_views.h"

#include <gtest/gtest.h>

#include <numbers>

#include "support/synthetic_world.h"

namespace hullslam {
namespace {

// A camera in a map of two keyframes, whose poses are true.
class JoinRequestsTest : public testing::Test {
 protected:
  PoseEstimate At(const Rigid3& cam_from_world) const {
    PoseEstimate estimate;
    estimate.cam_from_world = cam_from_world;
    for (const uint32_t point : world_.Observe(FrameId(99), cam_from_world).points) {
      estimate.landmarks.push_back(made_.landmarks[point]);
    }
    return estimate;
  }
  static Rigid3 Turned(double degrees) {
    return {ExpSo3({0.0, degrees * std::numbers::pi / 180.0, 0.0}), Eigen::Vector3d::Zero()};
  }
  static Rigid3 Moved(double metres) {
    return {Eigen::Quaterniond::Identity(), {metres, 0.0, 0.0}};
  }
  bool MayAskAgain(const PoseEstimate& estimate) {
    return requests_.MayAskAgain(made_.map, world_.sensor(), KeyframeId(0), estimate);
  }
  // Asks as often as it may; returns how often, at most 100 times.
  int AskAt(const Rigid3& cam_from_world) {
    const PoseEstimate estimate = At(cam_from_world);
    int count = 0;
    while (count < 100 && MayAskAgain(estimate)) {
      requests_.Add(made_.map, KeyframeId(0), estimate);
      ++count;
    }
    return count;
  }

  const SyntheticWorld world_{{.points = 800}};
  SyntheticMap made_ = MakeSyntheticMap(world_, {0, 5});
  JoinRequests requests_;
};

TEST_F(JoinRequestsTest, AreFewInOneView) {
  EXPECT_EQ(AskAt(Rigid3()), 4);
  EXPECT_EQ(AskAt(Rigid3()), 0);
  EXPECT_EQ(AskAt(Turned(1.0)), 0);
  EXPECT_EQ(AskAt(Moved(0.1)), 0);
}

TEST_F(JoinRequestsTest, BeginAgainInEachNewView) {
  AskAt(Rigid3());
  EXPECT_EQ(AskAt(Turned(12.0)), 4) << "another part of the scene";
  EXPECT_EQ(AskAt(Moved(0.9)), 4) << "the same part from another direction";
  EXPECT_EQ(AskAt(Rigid3()), 4);
}

// A slow camera comes to another view, too.
TEST_F(JoinRequestsTest, AreOfTheFirstFrameOfTheView) {
  int count = 0;
  for (double degrees = 0.0; degrees <= 24.0; degrees += 0.5) {
    count += AskAt(Turned(degrees));
  }
  EXPECT_GE(count, 8);
  EXPECT_LE(count, 24);
}

TEST_F(JoinRequestsTest, OfAnotherIslandDoNotCount) {
  AskAt(Rigid3());
  const KeyframeId other = made_.map.AddKeyframe(world_.Observe(FrameId(50), Rigid3()).frame,
                                                 Rigid3(), made_.map.BeginIsland());
  const PoseEstimate estimate = At(Rigid3());
  EXPECT_TRUE(requests_.MayAskAgain(made_.map, world_.sensor(), other, estimate));
}

// A camera in a map of two keyframes that are 0.2 s apart. Much later it may be there again.
class KnownView : public testing::Test {
 protected:
  // The camera finds each `period`th of the landmarks that it sees.
  bool IsKnown(const Rigid3& motion, double seconds_later, size_t period = 1) const {
    const Keyframe& first = made_.map.keyframes().At(KeyframeId(0));
    PoseEstimate estimate;
    estimate.cam_from_world = motion * first.cam_from_world;
    const SyntheticView view = world_.Observe(FrameId(99), estimate.cam_from_world);
    for (size_t i = 0; i < view.points.size(); ++i) {
      estimate.landmarks.push_back(i % period == 0 ? made_.landmarks[view.points[i]]
                                                   : LandmarkId());
    }
    Frame frame = *view.frame;
    frame.timestamp = first.frame->timestamp + seconds_later;
    return IsKnownView(made_.map, world_.sensor(), frame, first_of_session_, KeyframeId(0),
                       estimate);
  }
  static Rigid3 Moved(double x, double z = 0.0) {
    return {Eigen::Quaterniond::Identity(), {x, 0.0, z}};
  }
  static Rigid3 Turned(double radians) {
    return {ExpSo3({0.0, radians, 0.0}), Eigen::Vector3d::Zero()};
  }

  FrameId first_of_session_ = FrameId(0);
  const SyntheticWorld world_;
  SyntheticMap made_ = MakeSyntheticMap(world_, {0, 5});
};

TEST_F(KnownView, IsOneOfAnotherTime) {
  EXPECT_TRUE(IsKnown(Rigid3(), 60.0));
  EXPECT_FALSE(IsKnown(Rigid3(), 10.0)) << "keyframes along a path are as dense as ever";
}

TEST_F(KnownView, IsNoneOfAnEarlierSession) {
  EXPECT_TRUE(IsKnown(Rigid3(), 60.0));
  first_of_session_ = FrameId(50);
  EXPECT_FALSE(IsKnown(Rigid3(), 60.0)) << "things may have changed";
}

// The points are 2 to 6 m away, half of them nearer than 4 m. 4 % of the width are 26 px, or 0.2 m
// at 4 m.
TEST_F(KnownView, IsSeenFromAlmostTheSamePlace) {
  EXPECT_TRUE(IsKnown(Moved(0.15), 60.0));
  EXPECT_FALSE(IsKnown(Moved(-0.6), 60.0));
  EXPECT_TRUE(IsKnown(Turned(0.03), 60.0));
  EXPECT_FALSE(IsKnown(Turned(-0.1), 60.0));
  EXPECT_TRUE(IsKnown(Moved(0.0, -0.2), 60.0));
  EXPECT_FALSE(IsKnown(Moved(0.0, -0.8), 60.0)) << "much nearer, in the middle of the image";
}

TEST_F(KnownView, IsAlsoThatOfACovisibleKeyframe) {
  const Keyframe& first = made_.map.keyframes().At(KeyframeId(0));
  const Keyframe& second = made_.map.keyframes().At(KeyframeId(1));
  const Rigid3 between = second.cam_from_world * Inverse(first.cam_from_world);
  ASSERT_FALSE(first.covisible.empty());
  EXPECT_TRUE(IsKnown(between, 60.0));
}

TEST_F(KnownView, IsNoneIfItsLandmarksAreNotFound) {
  EXPECT_TRUE(IsKnown(Rigid3(), 60.0, 2));
  EXPECT_FALSE(IsKnown(Rigid3(), 60.0, 6)) << "the light has changed";
}

// A camera in a map of five keyframes that are 0.2 s apart. Later it comes back on another course.
class WellMapped : public testing::Test {
 protected:
  // The camera finds each `period`th of the landmarks that it should see, in the part of the image
  // to the left of this column.
  bool Is(const Rigid3& motion, double seconds_later, size_t period = 1,
          float column = 1e4f) const {
    const Keyframe& middle = made_.map.keyframes().At(KeyframeId(2));
    LocalTracking tracking;
    tracking.reference = KeyframeId(2);
    tracking.estimate.cam_from_world = motion * middle.cam_from_world;
    const SyntheticView view = world_.Observe(FrameId(99), tracking.estimate.cam_from_world);
    for (size_t i = 0; i < view.points.size(); ++i) {
      const LandmarkId landmark = made_.landmarks[view.points[i]];
      const bool is_mapped = view.frame->features.keypoints[i].undistorted.x() < column;
      const bool is_found = is_mapped && i % period == 0;
      if (is_mapped && landmark.IsValid()) {
        tracking.visible.push_back(landmark);
      }
      tracking.estimate.landmarks.push_back(is_found ? landmark : LandmarkId());
      tracking.estimate.inliers += is_found && landmark.IsValid() ? 1 : 0;
    }
    Frame frame = *view.frame;
    frame.timestamp = middle.frame->timestamp + seconds_later;
    return IsWellMapped(made_.map, world_.sensor(), frame, first_of_session_, tracking);
  }
  static Rigid3 Moved(double x, double z = 0.0) {
    return {Eigen::Quaterniond::Identity(), {x, 0.0, z}};
  }

  FrameId first_of_session_ = FrameId(0);
  const SyntheticWorld world_{{.points = 800}};
  SyntheticMap made_ = MakeSyntheticMap(world_, {0, 2, 4, 6, 8});
};

TEST_F(WellMapped, IsAPlaceThatEnoughOldKeyframesShow) {
  EXPECT_TRUE(Is(Rigid3(), 100.0));
  EXPECT_TRUE(Is(Moved(0.3), 100.0)) << "on another course";
  EXPECT_FALSE(Is(Rigid3(), 50.0)) << "a run of a minute is as it was";
  EXPECT_FALSE(Is(Moved(0.0, 3.0), 100.0)) << "from much farther away";
}

TEST_F(WellMapped, IsAlsoAPlaceWhereAKeyframeWouldBeRedundant) {
  const Rigid3 aside = Moved(-1.4);  // only one keyframe shows the landmarks from there
  EXPECT_TRUE(Is(aside, 100.0));
  made_.map.CullKeyframe(KeyframeId(1));
  EXPECT_TRUE(Is(aside, 100.0)) << "four see them";
  made_.map.CullKeyframe(KeyframeId(3));
  EXPECT_FALSE(Is(aside, 100.0)) << "three see them";
}

// As at the end of a lap that is not yet tied to its beginning.
TEST_F(WellMapped, HasFewLandmarksThatOldKeyframesDoNotShow) {
  made_.map.CullKeyframe(KeyframeId(1));
  ASSERT_TRUE(Is(Moved(-1.4), 100.0));
  const std::vector<LandmarkId> landmarks = made_.map.keyframes().At(KeyframeId(3)).landmarks;
  for (size_t i = 0; i < landmarks.size(); i += 7) {
    if (landmarks[i].IsValid()) {
      made_.map.RemoveObservation(landmarks[i], KeyframeId(3));
    }
  }
  EXPECT_FALSE(Is(Moved(-1.4), 100.0));
}

TEST_F(WellMapped, HalfOfTheLandmarksMustBeFound) {
  EXPECT_TRUE(Is(Rigid3(), 100.0, 2)) << "mapped by day and by lamp";
  EXPECT_FALSE(Is(Rigid3(), 100.0, 3));
}

TEST_F(WellMapped, AllOfTheImageMustBeMapped) { EXPECT_FALSE(Is(Rigid3(), 100.0, 1, 320.0f)); }

TEST_F(WellMapped, IsNothingOfAnEarlierSession) {
  first_of_session_ = FrameId(50);
  EXPECT_FALSE(Is(Rigid3(), 100.0));
}

// A camera that does not move, before a wall 3 m away, in a map with one keyframe that shows one
// mapped object in the middle, 2 m away.
class Changes : public testing::Test {
 protected:
  Changes() {
    object_ = made_.map.AddObject();
    ObjectLandmark& object = made_.map.MutableObject(object_);
    object.state = ObjectState::kMapped;
    object.has_shape = true;
    object.ellipsoid = {{Eigen::Quaterniond::Identity(), {0.0, 0.0, 2.0}},
                        Eigen::Vector3d::Constant(0.3)};
    made_.map.MutableKeyframe(KeyframeId(0)).objects = {object_};
    tracking_.reference = KeyframeId(0);
  }

  // A frame with a thing of this class (null: none) at this column; `object` is what it shows.
  int Follow(const char* label, double x, ObjectId object = ObjectId(), int depth = 0) {
    Frame frame;
    frame.timestamp = time_ += 1.0 / 30.0;
    tracking_.objects.clear();
    if (label != nullptr) {
      Detection& detection = frame.detections.emplace_back();
      detection.label = label;
      detection.box = {Eigen::Vector2d(x, 10.0), Eigen::Vector2d(x + 50.0, 60.0)};
      detection.points = std::vector<Eigen::Vector3d>{{x / 100.0, -1.0, 2.0}};
      tracking_.objects.push_back(object);
    }
    if (depth > 0) {
      frame.depth = DepthGrid(cv::Mat(480, 640, CV_16UC1, cv::Scalar(depth)), 1000.0);
    }
    const ObjectIndex index;
    const TrackingOptions options;
    const ObjectOptions objects;
    return changes_.Follow(frame, made_.map, {world_.sensor(), options, objects, index}, tracking_);
  }

  const SyntheticWorld world_;
  SyntheticMap made_ = MakeSyntheticMap(world_, {0});
  ObjectId object_;
  LocalTracking tracking_;
  LastingChanges changes_;
  double time_ = 0.0;
};

TEST_F(Changes, ThatLastForTenFramesAreAReason) {
  for (int i = 0; i < 9; ++i) {
    EXPECT_EQ(Follow("cup", 8.0 * i), 0);
    Follow(nullptr, 0.0);  // missed now and then
  }
  EXPECT_EQ(Follow("cup", 72.0), 1);
  for (int i = 0; i < 3; ++i) {
    Follow(nullptr, 0.0);
  }
  EXPECT_EQ(Follow("cup", 72.0), 0) << "it was gone for too long";
}

TEST_F(Changes, MistakesOfADetectorAreNoReason) {
  for (int i = 0; i < 30; ++i) {
    EXPECT_EQ(Follow("cup", i % 2 == 0 ? 10.0 : 300.0 + 60.0 * i), 0);
    EXPECT_EQ(Follow(i % 2 == 0 ? "book" : nullptr, 10.0), 0);
    EXPECT_EQ(Follow(nullptr, 0.0), 0);
    EXPECT_EQ(Follow("cup", 500.0, ObjectId(3)), 0) << "it is known";
  }
}

TEST_F(Changes, AreBeingLearntOnceTheyHaveMadeAKeyframe) {
  for (int i = 0; i < 12; ++i) {
    Follow("cup", 10.0);
  }
  EXPECT_FALSE(changes_.IsBeingLearnt());
  changes_.NoteRequest();
  EXPECT_TRUE(changes_.IsBeingLearnt());
  Follow("cup", 10.0, ObjectId(3));
  EXPECT_FALSE(changes_.IsBeingLearnt()) << "it is known";
}

TEST_F(Changes, AreAReasonEightTimesInHalfAnHour) {
  const auto count_requests = [&](double x) {
    int requests = 0;
    for (int i = 0; i < 100; ++i) {
      if (Follow("cup", x) > 0) {
        changes_.NoteRequest();
        ++requests;
      }
    }
    return requests;
  };
  EXPECT_EQ(count_requests(10.0), 8);
  EXPECT_EQ(count_requests(10.0), 0);
  EXPECT_EQ(count_requests(300.0), 8) << "at another place";
  time_ += 1900.0;
  EXPECT_EQ(count_requests(10.0), 8) << "after half an hour";
}

TEST_F(Changes, AnObjectThatIsGoneIsAReason) {
  int reasons = 0;
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(Follow(nullptr, 0.0, ObjectId(), 2000), 0) << "something is there";
  }
  for (int i = 0; i < 20; ++i) {
    reasons += Follow(nullptr, 0.0, ObjectId(), 3000);
  }
  EXPECT_EQ(reasons, 11);
  EXPECT_EQ(Follow("cup", 10.0, object_, 3000), 0) << "it is found";
}

}  // namespace
}  // namespace hullslam
