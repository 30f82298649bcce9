// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/association.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "geometry/polygon.h"
#include "objects/constraint/point_statistics.h"
#include "objects/made_objects.h"

namespace hullslam {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

// A detection without depth whose hull is a square of 40 px, and an object of its class that is
// predicted there.
class CombinedSimilarityTest : public ::testing::Test {
 protected:
  CombinedSimilarityTest() {
    detection_.label = "cup";
    detection_.hull = Square(0.0);
    object_.votes["cup"] = 3;
    seen_.detection = &detection_;
    predicted_.object = &object_;
    predicted_.ellipse = Square(0.0);
  }
  static Polygon Square(double x) {
    return {{x, 0.0}, {x + 40.0, 0.0}, {x + 40.0, 40.0}, {x, 40.0}};
  }
  double Similarity() const { return CombinedSimilarity(seen_, predicted_, options_); }

  Detection detection_;
  ObjectLandmark object_;
  SeenObject seen_;
  PredictedObject predicted_;
  AssociationOptions options_;
};

TEST_F(CombinedSimilarityTest, IsTheWeightedSumOfWhatAgrees) {
  EXPECT_NEAR(Similarity(), options_.iou_weight + options_.class_weight, 1e-12);
  object_.votes["bowl"] = 1;
  EXPECT_NEAR(Similarity(), options_.iou_weight + 0.75 * options_.class_weight, 1e-12);
  seen_.landmarks = {LandmarkId(0, 0), LandmarkId(1, 0), LandmarkId(2, 0), LandmarkId(3, 0)};
  predicted_.landmarks = seen_.landmarks;
  predicted_.landmarks.erase(predicted_.landmarks.begin());
  EXPECT_EQ(CountShared(seen_, predicted_), 3u);
  EXPECT_NEAR(Similarity(),
              options_.iou_weight + options_.landmark_weight + 0.75 * options_.class_weight, 1e-12);
}

TEST_F(CombinedSimilarityTest, NothingThatAgreesIsNoMatch) {
  predicted_.ellipse = Square(35.0);
  EXPECT_EQ(Similarity(), 0.0);
  predicted_.carried = {Square(0.0)};
  EXPECT_NEAR(Similarity(), options_.iou_weight + options_.class_weight, 1e-12);
  predicted_.carried = {Square(0.0), Square(100.0)};
  EXPECT_GT(Similarity(), 0.0);
  detection_.label = "bowl";
  EXPECT_EQ(Similarity(), 0.0) << "one of many positions must have the same class";
}

TEST_F(CombinedSimilarityTest, CloudsThatAreApartExcludeAPair) {
  seen_.cloud = {{0.0, 0.0, 1.0}, {0.1, 0.0, 1.0}};
  seen_.centroid = {0.05, 0.0, 1.0};
  seen_.size = SizeOf(seen_.cloud);
  predicted_.cloud = seen_.cloud;
  predicted_.centroid = seen_.centroid;
  predicted_.size = SizeOf(predicted_.cloud);
  EXPECT_DOUBLE_EQ(predicted_.size, 0.1);
  EXPECT_FALSE(AreApart(seen_, predicted_, options_));
  EXPECT_GT(Similarity(), 0.0);
  for (Eigen::Vector3d& point : predicted_.cloud) {
    point.z() += 1.01 * options_.max_offset * predicted_.size;
  }
  predicted_.centroid = MeanOf(predicted_.cloud);
  EXPECT_TRUE(AreApart(seen_, predicted_, options_));
  EXPECT_EQ(Similarity(), 0.0);
  seen_.noise = 1.0;
  EXPECT_FALSE(AreApart(seen_, predicted_, options_)) << "within the noise of the depth";
}

class Association : public ::testing::Test {
 protected:
  // A map in which each of these is an object seen by `keyframes` keyframes.
  void Build(const std::vector<MadeObject>& objects, int keyframes, bool with_shape) {
    for (const MadeObject& made : objects) {
      const ObjectId id = map_.AddObject();
      map_.MutableObject(id).has_shape = with_shape;
      map_.MutableObject(id).ellipsoid = made.ellipsoid;
    }
    for (int i = 0; i < keyframes; ++i) {
      const KeyframeId keyframe =
          AddObserver(map_, sensor_, CameraOnCircle(0.05 * i, 1.5, 0.6), objects);
      for (uint32_t k = 0; k < objects.size(); ++k) {
        map_.AddObservation(ObjectId(k), keyframe, k);
      }
    }
  }
  std::vector<ObjectId> Associate(const std::vector<MadeObject>& seen, double angle,
                                  const AssociationOptions& options = {},
                                  AssociationScope scope = AssociationScope::kAll) {
    const Rigid3 cam_from_world = CameraOnCircle(angle, 1.5, 0.6);
    Frame frame;
    for (const MadeObject& object : seen) {
      frame.detections.push_back(Detect(object, sensor_, cam_from_world));
    }
    return Associate(frame, cam_from_world, options, {}, scope);
  }
  std::vector<ObjectId> Associate(const Frame& frame, const Rigid3& cam_from_world,
                                  const AssociationOptions& options = {},
                                  std::span<const LandmarkId> landmarks = {},
                                  AssociationScope scope = AssociationScope::kAll) {
    return AssociateDetections({.map = map_,
                                .index = ObjectIndex(map_, sensor_.camera),
                                .sensor = sensor_,
                                .frame = frame,
                                .cam_from_world = cam_from_world,
                                .island = IslandId(0),
                                .landmarks = landmarks,
                                .scope = scope},
                               options);
  }
  Sensor sensor_ = MakeObjectSensor();
  Map map_;
};

TEST_F(Association, FindsEveryObjectInAnyOrder) {
  const auto table = MakeTable();
  Build(table, 3, true);
  const auto found = Associate({table[2], table[0], table[1]}, 0.2);
  EXPECT_EQ(found, (std::vector<ObjectId>{ObjectId(2), ObjectId(0), ObjectId(1)}));
}

TEST_F(Association, FindsCandidatesThatWereSeenOnce) {
  const auto table = MakeTable();
  Build(table, 1, false);
  const auto found = Associate(table, 0.1);
  EXPECT_EQ(found, (std::vector<ObjectId>{ObjectId(0), ObjectId(1), ObjectId(2)}));
  EXPECT_EQ(Associate(table, 0.1, {}, AssociationScope::kMapped), std::vector<ObjectId>(3));
}

TEST_F(Association, ANewThingShowsNoObject) {
  const auto table = MakeTable();
  Build({table[0], table[1]}, 3, true);
  EXPECT_FALSE(Associate({table[2]}, 0.1)[0].IsValid());
  EXPECT_TRUE(Associate({}, 0.1).empty());
}

TEST_F(Association, AnotherClassDoesNotExcludeAMatch) {
  const auto table = MakeTable();
  Build(table, 3, true);
  MadeObject laptop = table[1];
  laptop.label = "laptop";
  EXPECT_EQ(Associate({laptop}, 0.1)[0], ObjectId(1));
}

TEST_F(Association, ForTheMeasureOfOaSlamAnotherClassExcludesAMatch) {
  const auto table = MakeTable();
  Build(table, 3, true);
  MadeObject laptop = table[1];
  laptop.label = "laptop";
  const AssociationOptions options{.measure = AssociationMeasure::kClassOverlap};
  EXPECT_FALSE(Associate({laptop}, 0.1, options)[0].IsValid());
}

TEST_F(Association, EveryMeasureFindsEveryObject) {
  const auto table = MakeTable();
  Build(table, 3, true);
  for (const AssociationMeasure measure :
       {AssociationMeasure::kCombined, AssociationMeasure::kClassOverlap,
        AssociationMeasure::kWasserstein}) {
    const auto found = Associate({table[2], table[0], table[1]}, 0.2, {.measure = measure});
    EXPECT_EQ(found, (std::vector<ObjectId>{ObjectId(2), ObjectId(0), ObjectId(1)}));
  }
}

TEST_F(Association, OfTwoCandidatesTheClassDecides) {
  auto twin = MakeTable();
  twin.resize(1);
  MadeObject other = twin[0];
  other.label = "vase";
  Build({twin[0], other}, 3, true);
  EXPECT_EQ(Associate({other}, 0.1)[0], ObjectId(1));
  EXPECT_EQ(Associate({twin[0]}, 0.1)[0], ObjectId(0));
}

TEST_F(Association, ThingsOneBehindTheOtherAreTwo) {
  // A thing with the same outline from this pose, but 60 cm farther away.
  const MadeObject cup = MakeObject("cup", Eigen::Vector3d::Zero(), {0.08, 0.08, 0.08});
  Build({cup}, 3, true);
  const Eigen::Vector3d camera = Inverse(CameraOnCircle(0.1, 1.5, 0.6)).translation;
  MadeObject behind = cup;
  const double ratio = (camera.norm() + 0.6) / camera.norm();
  behind.ellipsoid.world_from_object.translation = camera * (1.0 - ratio);
  behind.ellipsoid.half_axes *= ratio;
  EXPECT_FALSE(Associate({behind}, 0.1)[0].IsValid());
}

TEST_F(Association, WithoutDepthTheOutlineDecides) {
  const auto table = MakeTable();
  Build(table, 3, true);
  const Rigid3 cam_from_world = CameraOnCircle(0.2, 1.5, 0.6);
  Frame frame;
  for (const MadeObject& object : table) {
    frame.detections.push_back(Detect(object, sensor_, cam_from_world));
    frame.detections.back().points.clear();
  }
  EXPECT_EQ(Associate(frame, cam_from_world),
            (std::vector<ObjectId>{ObjectId(0), ObjectId(1), ObjectId(2)}));
}

TEST_F(Association, NothingIsSimilarEnoughForAHighThreshold) {
  const auto table = MakeTable();
  Build(table, 3, true);
  EXPECT_TRUE(Associate(table, 0.2, {.min_similarity = 0.2})[0].IsValid());
  EXPECT_FALSE(Associate(table, 0.2, {.min_similarity = 1.0})[0].IsValid());
}

// A thing that is seen without depth beside an object. Only the outlines can tell whether they are
// the same.
class Beside : public Association {
 protected:
  std::vector<ObjectId> AssociateBeside(const AssociationOptions& options) {
    Frame frame;
    frame.detections.push_back(Detect(beside_, sensor_, CameraOnCircle(0.0, 1.5, 0.6)));
    frame.detections.back().points.clear();
    return Associate(frame, CameraOnCircle(0.0, 1.5, 0.6), options);
  }
  double Overlap() const {
    const Rigid3 pose = CameraOnCircle(0.0, 1.5, 0.6);
    return IntersectionOverUnion(Detect(cup_, sensor_, pose).hull,
                                 Detect(beside_, sensor_, pose).hull);
  }
  static constexpr double kNever = 1.1;  // larger than any IoU
  MadeObject cup_ = MakeObject("cup", Eigen::Vector3d::Zero(), {0.08, 0.08, 0.08});
  MadeObject beside_ = MakeObject("cup", {0.0, 0.04, 0.0}, {0.08, 0.08, 0.08});
};

TEST_F(Beside, TheProjectedEllipseMustHaveTheLeastOverlap) {
  Build({cup_}, 1, true);
  AssociationOptions options{.min_carried_iou = kNever, .min_similarity = 0.01};
  options.min_projection_iou = Overlap() - 0.02;
  EXPECT_EQ(AssociateBeside(options)[0], ObjectId(0));
  options.min_projection_iou = Overlap() + 0.02;
  EXPECT_FALSE(AssociateBeside(options)[0].IsValid());
}

TEST_F(Beside, TheLastHullMustHaveTheLeastOverlap) {
  Build({cup_}, 1, false);
  AssociationOptions options{.min_projection_iou = kNever, .min_similarity = 0.01};
  options.min_carried_iou = Overlap() - 0.02;
  EXPECT_EQ(AssociateBeside(options)[0], ObjectId(0));
  options.min_carried_iou = Overlap() + 0.02;
  EXPECT_FALSE(AssociateBeside(options)[0].IsValid());
}

TEST_F(Beside, DepthThatAgreesNeedsSomeOverlap) {
  Build({cup_}, 1, true);
  AssociationOptions options{.min_projection_iou = kNever, .min_carried_iou = kNever};
  options.min_depth_iou = 0.9;
  EXPECT_EQ(Associate({cup_}, 0.0, options)[0], ObjectId(0));
  options.min_depth_iou = 1.0;
  EXPECT_FALSE(Associate({cup_}, 0.0, options)[0].IsValid());
}

// All landmarks on the thing are those of the object, but these must be three or more.
TEST_F(Association, AFewCommonLandmarksAreNotEnough) {
  auto frame = std::make_shared<Frame>();
  frame->features.keypoints.resize(3);
  frame->features.descriptors.resize(3);
  frame->features.depth.resize(3, 0.0f);
  const Rigid3 pose = CameraOnCircle(0.0, 1.5, 0.6);
  const auto table = MakeTable();
  frame->detections.push_back(Detect(table[0], sensor_, pose));
  frame->detections.back().keypoints = {0, 1, 2};
  const KeyframeId keyframe = map_.AddKeyframe(frame, pose);
  map_.AddObservation(map_.AddObject(), keyframe, 0);
  std::vector<LandmarkId> landmarks;
  for (uint32_t i = 0; i < 3; ++i) {
    landmarks.push_back(map_.AddLandmark(Eigen::Vector3d::Zero(), keyframe));
    map_.AddObservation(landmarks.back(), keyframe, i);
  }
  Frame next;
  next.features = frame->features;
  next.detections.push_back(Detect(table[1], sensor_, pose));  // elsewhere in the image
  next.detections.back().keypoints = {0, 1, 2};
  next.detections.back().points.clear();
  const auto associate = [&] {
    return Associate(next, pose, {.min_similarity = 0.01}, landmarks)[0];
  };
  EXPECT_EQ(associate(), ObjectId(0));
  landmarks[2] = LandmarkId();
  EXPECT_FALSE(associate().IsValid());
}

// A monocular camera that moves sideways past a cup, which is 0.06 m wide and 1 m away. The first
// observation does not tell how far away the cup is.
class UnknownDepth : public Association {
 protected:
  static Rigid3 Sideways(double x) { return {Eigen::Quaterniond::Identity(), {-x, 0.0, 0.0}}; }
  Frame See(const MadeObject& object, double x) const {
    Frame frame;
    frame.detections.push_back(Detect(object, sensor_, Sideways(x)));
    frame.detections.back().points.clear();
    return frame;
  }
  ObjectId Associate(const MadeObject& object, double x) {
    return Association::Associate(See(object, x), Sideways(x))[0];
  }
  void Add(double x) {
    const KeyframeId keyframe =
        map_.AddKeyframe(std::make_shared<Frame>(See(cup_, x)), Sideways(x));
    map_.AddObservation(ObjectId(0), keyframe, 0);
  }
  MadeObject cup_ = MakeObject("cup", {0.0, 0.0, 1.0}, {0.03, 0.03, 0.03});
};

TEST_F(UnknownDepth, TheHullMayHaveMovedAlongTheEpipolarLine) {
  map_.AddObject();
  Add(0.0);
  EXPECT_EQ(Associate(cup_, 0.01), ObjectId(0));
  EXPECT_EQ(Associate(cup_, 0.05), ObjectId(0));  // 26 px, nearly its size
  EXPECT_FALSE(Associate(cup_, 0.12).IsValid());  // more than its size
  MadeObject bowl = cup_;
  bowl.label = "bowl";
  EXPECT_FALSE(Associate(bowl, 0.05).IsValid());
  MadeObject above = cup_;
  above.ellipsoid.world_from_object.translation.y() = -0.05;  // off the epipolar line
  EXPECT_FALSE(Associate(above, 0.05).IsValid());
}

TEST_F(UnknownDepth, TwoViewsTellTheDepth) {
  map_.AddObject();
  Add(0.0);
  Add(0.15);
  EXPECT_EQ(Associate(cup_, 0.3), ObjectId(0));
  MadeObject bowl = cup_;
  bowl.label = "bowl";
  EXPECT_EQ(Associate(bowl, 0.3), ObjectId(0));  // where the cup must be
}

}  // namespace

}  // namespace hullslam
