// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/mapper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ios>
#include <map>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "frame/rolling_shutter.h"
#include "map_files/invariants.h"
#include "objects/made_objects.h"
#include "support/synthetic_world.h"
#include "support/test_cameras.h"
#include "system/finish_run.h"

namespace hullslam {
namespace {

// Sends keyframes of the synthetic world to a mapper, like a tracker that finds the true poses.
class MapperTest : public testing::Test {
 protected:
  explicit MapperTest(const SyntheticWorldOptions& world = {.points = 400, .pixel_noise = 0.1},
                      const Sensor& sensor = SyntheticSensor())
      : world_(world, sensor) {}

  void SetUp() override { Restart({}); }

  void Restart(const MappingOptions& options) {
    published_.clear();
    landmark_of_point_.clear();
    mapper_ = std::make_unique<Mapper>(world_.sensor(), options, ObjectOptions(), [this](auto map) {
      EXPECT_EQ(FindViolations(*map), std::vector<std::string>());
      published_.push_back(std::move(map));
    });
  }

  const Map& map() const { return *published_.back(); }

  // The initial map of the path's frame `index` alone: its points with depth, nearest first.
  InitialMap Initial(uint32_t index) const {
    const SyntheticView view = world_.Observe(index);
    const FrameFeatures& features = view.frame->features;
    InitialMap initial;
    initial.views.push_back({view.frame, Rigid3()});
    for (const uint32_t i : KeypointsByDepth(features)) {
      const Eigen::Vector2d pixel = features.keypoints[i].undistorted.cast<double>();
      const auto depth = static_cast<double>(features.depth[i]);
      initial.points.push_back({world_.sensor().camera.Unproject(pixel, depth), {{0, i}}});
    }
    return initial;
  }

  // The request for the path's frame `index` relative to `reference`.
  KeyframeRequest Request(uint32_t index, KeyframeId reference) const {
    const SyntheticView view = world_.Observe(index);
    KeyframeRequest request;
    request.frame = view.frame;
    request.pose = map().RelativeTo(reference, SyntheticWorld::CamFromWorld(index));
    for (const uint32_t point : view.points) {
      const auto known = landmark_of_point_.find(point);
      request.landmarks.push_back(known != landmark_of_point_.end() ? known->second : LandmarkId());
      if (request.landmarks.back().IsValid()) {
        request.sightings.push_back({request.landmarks.back(), 1, 1});
      }
    }
    return request;
  }

  void Process(const MapMessage& message, const Cancellation* hurry = nullptr) {
    mapper_->Process(message, hurry);
    Learn();
  }
  // The reference is the newest keyframe that is in the map.
  void ProcessFrame(uint32_t index, const Cancellation* hurry = nullptr) {
    if (published_.empty()) {
      Process(Initial(index), hurry);
      return;
    }
    KeyframeId newest;
    map().keyframes().ForEach([&](KeyframeId id, const Keyframe&) { newest = id; });
    Process(Request(index, newest), hurry);
  }

  // The landmark of each point in the newest map. The descriptor identifies the point.
  void Learn() {
    std::map<Descriptor, LandmarkId> by_descriptor;
    map().landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
      by_descriptor.emplace(landmark.descriptor, id);
    });
    landmark_of_point_.clear();
    for (uint32_t point = 0; point < world_.points().size(); ++point) {
      const auto landmark = by_descriptor.find(world_.descriptor(point));
      if (landmark != by_descriptor.end()) {
        landmark_of_point_[point] = landmark->second;
      }
    }
  }

  double MeanLandmarkError() const {
    double sum = 0.0;
    for (const auto& [point, landmark] : landmark_of_point_) {
      sum += (map().landmarks().At(landmark).position - world_.points()[point]).norm();
    }
    return sum / static_cast<double>(landmark_of_point_.size());
  }

  const SyntheticWorld world_;
  std::unique_ptr<Mapper> mapper_;
  std::vector<std::shared_ptr<const Map>> published_;
  std::map<uint32_t, LandmarkId> landmark_of_point_;
};

class MapperWith : public MapperTest, public testing::WithParamInterface<TestCamera> {
 protected:
  MapperWith() : MapperTest({.points = 400, .pixel_noise = 0.1}, GetParam().sensor) {}
};

HULLSLAM_WITH_ALL_CAMERAS(MapperWith);

TEST_F(MapperTest, PublishesBeforeAndAfterItsWork) {
  ProcessFrame(0);
  ASSERT_EQ(published_.size(), 2u);
  EXPECT_EQ(published_[0]->keyframes().size(), 1u)
      << "tracking gets the keyframe before the other steps are done";
  ProcessFrame(5);
  EXPECT_EQ(published_.size(), 4u);
}

TEST_P(MapperWith, BuildsAConsistentMapNearTheTruth) {
  for (uint32_t index = 0; index <= 60; index += 5) {
    ProcessFrame(index);
  }
  EXPECT_GT(landmark_of_point_.size(), 250u);
  EXPECT_LT(MeanLandmarkError(), 0.03);
  map().keyframes().ForEach([&](KeyframeId, const Keyframe& keyframe) {
    const Rigid3 truth = SyntheticWorld::CamFromWorld(keyframe.frame->id.value);
    const Rigid3 error = keyframe.cam_from_world * Inverse(truth);
    EXPECT_LT(error.translation.norm(), 0.02);
    EXPECT_LT(AngularDistance(error.rotation, Eigen::Quaterniond::Identity()), 0.01);
  });
}

// Points from number `left` on vanish, and depth images show a wall behind all that is there.
TEST_P(MapperWith, RemovesAndCountsTheLandmarksOfThingsThatHaveGone) {
  for (uint32_t index = 0; index <= 20; index += 5) {
    ProcessFrame(index);
  }
  constexpr uint32_t kLeft = 200;
  const auto gone_points = [&] {
    return std::count_if(landmark_of_point_.begin(), landmark_of_point_.end(),
                         [](const auto& entry) { return entry.first >= kLeft; });
  };
  const auto before = gone_points();
  ASSERT_GT(before, 100);
  const SyntheticWorld emptied({.points = kLeft, .pixel_noise = 0.1}, world_.sensor());
  const cv::Mat wall(480, 640, CV_16UC1, cv::Scalar(30000));
  for (uint32_t index = 25; index <= 40; index += 5) {
    const SyntheticView view = emptied.Observe(index);
    auto frame = std::make_shared<Frame>(*view.frame);
    frame->depth = DepthGrid(wall, 1000.0);
    KeyframeRequest request = Request(index, *mapper_->NewestKeyframe());
    request.frame = std::move(frame);
    request.landmarks.clear();
    for (const uint32_t point : view.points) {
      const auto known = landmark_of_point_.find(point);
      request.landmarks.push_back(known != landmark_of_point_.end() ? known->second : LandmarkId());
    }
    Process(request);
  }
  EXPECT_LT(gone_points(), 0.2 * static_cast<double>(before)) << "of " << before;
  EXPECT_GT(static_cast<double>(mapper_->contradicted_landmarks()),
            0.7 * static_cast<double>(before));
  EXPECT_GT(landmark_of_point_.size(), 100U) << "what is still there stays";
}

// Points from number `left` on are never found again, and no depth image tells why.
TEST_F(MapperTest, ForgetsTheLandmarksThatManyVisitsMiss) {
  for (uint32_t index = 0; index <= 20; index += 5) {
    ProcessFrame(index);
  }
  constexpr uint32_t kLeft = 200;
  const auto missing = [&] {
    return std::ranges::count_if(landmark_of_point_,
                                 [](const auto& entry) { return entry.first >= kLeft; });
  };
  const auto before = missing();
  ASSERT_GT(before, 100);
  const SyntheticWorld emptied({.points = kLeft, .pixel_noise = 0.1});
  for (uint32_t i = 0; i < 40; ++i) {
    const SyntheticView view = emptied.Observe(25 + i);
    auto frame = std::make_shared<Frame>(*view.frame);
    frame->timestamp = 1000.0 + 100.0 * i;
    KeyframeRequest request = Request(25 + i, *mapper_->NewestKeyframe());
    request.frame = std::move(frame);
    request.landmarks.clear();
    for (const uint32_t point : view.points) {
      const auto known = landmark_of_point_.find(point);
      request.landmarks.push_back(known != landmark_of_point_.end() ? known->second : LandmarkId());
    }
    request.sightings.clear();
    for (const auto& [point, landmark] : landmark_of_point_) {
      if (i % 2 == 1) {  // in between, the camera is elsewhere
        request.sightings.push_back({landmark, 50, point < kLeft ? 50 : 0});
      }
    }
    Process(request);
    if (i == 19) {
      EXPECT_GT(missing(), before / 2) << "ten visits are not enough";
    }
  }
  EXPECT_LT(missing(), before / 4) << "of " << before;
  EXPECT_GT(landmark_of_point_.size(), 100U) << "what is still there stays";
}

TEST_P(MapperWith, BundleAdjustmentCorrectsAWrongPose) {
  for (uint32_t index = 0; index <= 20; index += 5) {
    ProcessFrame(index);
  }
  KeyframeRequest request = Request(25, KeyframeId(0));
  request.pose.cam_from_reference.translation += Eigen::Vector3d(0.01, -0.01, 0.01);
  Process(request);
  const Keyframe& keyframe = map().keyframes().At(*map().KeyframeOfFrame(FrameId(25)));
  EXPECT_LT(
      (keyframe.cam_from_world.translation - SyntheticWorld::CamFromWorld(25).translation).norm(),
      0.005)
      << "it was wrong by 0.017 m";
}

// The content of a snapshot as text.
std::string Describe(const Map& map) {
  std::ostringstream text;
  text << std::hexfloat;
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    text << "keyframe " << id.value << ' ' << keyframe.cam_from_world.ToMatrix() << ' '
         << keyframe.parent.value;
    for (const LandmarkId landmark : keyframe.landmarks) {
      text << ' ' << landmark.value;
    }
    for (const Covisible& edge : keyframe.covisible) {
      text << ' ' << edge.keyframe.value << ':' << edge.shared;
    }
    text << '\n';
  });
  map.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    text << "landmark " << id.value << ' ' << landmark.position.transpose() << ' '
         << landmark.observation_weight << ' ' << landmark.visible << ' ' << landmark.found << ' '
         << landmark.max_distance << ' ' << landmark.viewing_direction.transpose() << '\n';
  });
  return text.str();
}

TEST_F(MapperTest, PublishedSnapshotsDoNotChange) {
  std::vector<std::string> described;
  for (uint32_t index = 0; index <= 30; index += 3) {
    ProcessFrame(index);
    for (size_t i = described.size(); i < published_.size(); ++i) {
      described.push_back(Describe(*published_[i]));
    }
  }
  EXPECT_NE(described.front(), described.back());
  for (size_t i = 0; i < published_.size(); ++i) {
    EXPECT_EQ(Describe(*published_[i]), described[i]) << "snapshot " << i;
  }
}

TEST_F(MapperTest, SameRequestsGiveTheSameBits) {
  const auto run = [&] {
    Restart({});
    for (uint32_t index = 0; index <= 30; index += 5) {
      ProcessFrame(index);
    }
    return Describe(map());
  };
  const std::string first = run();
  EXPECT_EQ(first, run());
}

TEST_F(MapperTest, RedundantKeyframesAreCulledIfTheOptionIsSet) {
  const auto count = [&](bool cull) {
    MappingOptions options;
    options.cull_keyframes = cull;
    Restart(options);
    for (uint32_t index = 0; index < 10; ++index) {
      ProcessFrame(index);
    }
    EXPECT_TRUE(map().keyframes().Contains(KeyframeId(0))) << "the root stays";
    return map().keyframes().size();
  };
  EXPECT_EQ(count(false), 10u);
  EXPECT_LT(count(true), 8u);
}

// Each keyframe is at another place, 100 m from the last one, so none is covisible with another.
TEST_F(MapperTest, DistantKeyframesAreCompactedIfTheOptionIsSet) {
  for (const bool compact : {false, true}) {
    MappingOptions options;
    options.compact_keyframes = compact;
    Restart(options);
    Process(Initial(0));
    const size_t keypoints = map().keyframes().At(KeyframeId(0)).frame->features.size();
    for (uint32_t index = 1; index <= 22; ++index) {
      KeyframeRequest request = Request(index, KeyframeId(index - 1));
      request.pose.cam_from_reference = {Eigen::Quaterniond::Identity(), {100.0, 0.0, 0.0}};
      request.landmarks.assign(request.landmarks.size(), LandmarkId());
      request.sightings.clear();
      Process(request);
    }
    for (const auto& [id, keyframe] : map().keyframes()) {
      const std::vector<LandmarkId>& landmarks = keyframe.landmarks;
      const bool is_full = std::any_of(landmarks.begin(), landmarks.end(),
                                       [](LandmarkId i) { return !i.IsValid(); });
      EXPECT_EQ(is_full, !compact || id.value >= 2) << id.value;
    }
    EXPECT_EQ(map().keyframes().At(KeyframeId(0)).frame->features.size() < keypoints, compact);
  }
}

TEST_F(MapperTest, ARequestMayReferToEntitiesThatNoLongerExist) {
  for (uint32_t index = 0; index < 8; ++index) {
    ProcessFrame(index);
  }
  // From an old snapshot: its reference and many of its landmarks no longer exist.
  KeyframeId culled;
  for (uint32_t id = 1; id < 8 && !culled.IsValid(); ++id) {
    culled = map().keyframes().Contains(KeyframeId(id)) ? KeyframeId() : KeyframeId(id);
  }
  ASSERT_TRUE(culled.IsValid());
  KeyframeRequest request = Request(12, culled);
  size_t gone = 0;
  published_.front()->landmarks().ForEach([&](LandmarkId id, const Landmark&) {
    if (!map().landmarks().Contains(id) && gone < request.landmarks.size()) {
      request.landmarks[gone++] = id;
      request.sightings.push_back({id, 3, 2});
    }
  });
  request.landmarks[gone] = LandmarkId(1000000);  // no landmark ever had this id
  Process(request);
  const std::optional<KeyframeId> keyframe = map().KeyframeOfFrame(FrameId(12));
  ASSERT_TRUE(keyframe);
  const Rigid3 error = map().CamFromWorld(*keyframe) * Inverse(SyntheticWorld::CamFromWorld(12));
  EXPECT_LT(error.translation.norm(), 0.02);
}

TEST_F(MapperTest, RemembersReplacedIdsOnlyWhileRequestsMayHaveThem) {
  const auto run = [&](bool is_current) {
    Restart({});
    for (uint32_t index = 0; index <= 24; index += 3) {
      if (published_.empty()) {
        ProcessFrame(index);
        continue;
      }
      KeyframeId newest;
      map().keyframes().ForEach([&](KeyframeId id, const Keyframe&) { newest = id; });
      KeyframeRequest request = Request(index, newest);
      request.oldest_revision = is_current ? map().revision() : 1;
      // A tracker that misses landmarks: they are made again from depth, and then fused.
      for (size_t i = 0; i < request.landmarks.size(); i += 2) {
        request.landmarks[i] = LandmarkId();
      }
      Process(request);
    }
    return map().replaced_count();
  };
  const size_t all = run(false);
  ASSERT_GT(all, 0u) << "no landmark was replaced, so nothing was tested";
  EXPECT_LT(run(true), all);
}

// A correction moves the whole map. A keyframe that was tracked before the correction follows it.
// The scale stays 1 because the depths of the frames are metric.
TEST_F(MapperTest, ACorrectionIsAppliedAndPublished) {
  for (uint32_t index = 0; index <= 20; index += 5) {
    ProcessFrame(index);
  }
  const std::shared_ptr<const Map> snapshot = published_.back();
  const Sim3 old_from_new(1.0, ExpSo3({0.1, 0.3, -0.2}), {1.0, 2.0, 3.0});
  MapCorrection correction;
  snapshot->keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    correction.poses.push_back(
        {id, keyframe.cam_from_world, Sim3(keyframe.cam_from_world) * old_from_new});
  });
  const KeyframeRequest request = Request(25, *snapshot->KeyframeOfFrame(FrameId(20)));
  Process(correction);
  ASSERT_NE(published_.back(), snapshot);
  EXPECT_EQ(map().correction_count(), 1u);
  Process(request);
  const Keyframe& keyframe = map().keyframes().At(*map().KeyframeOfFrame(FrameId(25)));
  const Eigen::Vector3d expected =
      Inverse(old_from_new) * Inverse(SyntheticWorld::CamFromWorld(25)).translation;
  EXPECT_LT((Inverse(keyframe.cam_from_world).translation - expected).norm(), 0.01);
  EXPECT_GT(keyframe.covisible.size(), 1u) << "it finds the landmarks at their new positions";

  const size_t published = published_.size();
  Process(correction);
  EXPECT_EQ(published_.size(), published) << "the same correction again is refused";
}

TEST_F(MapperTest, InAHurryItLeavesOutStepsThatAreNotNecessary) {
  Cancellation hurry;
  hurry.Request();
  for (uint32_t index = 0; index <= 30; index += 5) {
    ProcessFrame(index, &hurry);
  }
  EXPECT_EQ(map().keyframes().size(), 7u);
  EXPECT_FALSE(mapper_->times().samples().contains("local_bundle_adjustment"));
  ProcessFrame(35);
  EXPECT_EQ(mapper_->times().samples().at("local_bundle_adjustment").size(), 1u);
  EXPECT_EQ(mapper_->times().samples().at("map_insert").size(), 8u);
}

TEST_F(MapperTest, FinishAdjustsTheWholeMapIfTheOptionIsSet) {
  const auto map_path = [&](bool wanted) {
    MappingOptions options;
    options.local_keyframes = 2;
    options.fixed_keyframes = 1;
    options.final_bundle_adjustment = wanted;
    Restart(options);
    for (uint32_t index = 0; index <= 60; index += 5) {
      ProcessFrame(index);
    }
    const size_t published = published_.size();
    FinishMap(*mapper_);
    EXPECT_EQ(published_.size(), published + (wanted ? 1 : 0));
    EXPECT_EQ(mapper_->times().samples().contains("global_bundle_adjustment"), wanted);
    Learn();
    return MeanLandmarkError();
  };
  const double without = map_path(false);
  EXPECT_LT(map_path(true), 0.95 * without);
}

TEST_F(MapperTest, FinishDoesNothingWithFewerThanTwoKeyframesOrCancelled) {
  MappingOptions options;
  options.final_bundle_adjustment = true;
  Restart(options);
  FinishMap(*mapper_);
  EXPECT_TRUE(published_.empty());
  ProcessFrame(0);
  FinishMap(*mapper_);
  ProcessFrame(5);
  Cancellation cancellation;
  cancellation.Request();
  FinishMap(*mapper_, &cancellation);
  EXPECT_EQ(published_.size(), 4u);
  EXPECT_FALSE(mapper_->times().samples().contains("global_bundle_adjustment"));
}

// A cup in front of the camera; its detections come with the frames or after them.
class MapperLateMasksTest : public MapperTest {
 protected:
  Detection DetectCup(uint32_t index) const {
    return Detect(cup_, world_.sensor(), SyntheticWorld::CamFromWorld(index));
  }
  Detection DetectBook(uint32_t index) const {
    return Detect(MakeObject("book", {0.5, 0.1, 1.6}, {0.1, 0.07, 0.05}), world_.sensor(),
                  SyntheticWorld::CamFromWorld(index));
  }

  bool AddLate(uint32_t index) {
    return mapper_->Process(
        LateDetections{.frame = FrameId(index),
                       .detections = {DetectCup(index)},
                       .keypoints = world_.Observe(index).frame->features.size()},
        nullptr);
  }

  // The masks of a frame that is no keyframe yet.
  LateDetections OfTrackedFrame(uint32_t index, std::vector<Detection> detections) const {
    const KeyframeRequest request = Request(index, KeyframeId(0));
    return {.frame = FrameId(index),
            .detections = std::move(detections),
            .keypoints = request.frame->features.size(),
            .request = request};
  }

  void ProcessWithCup(uint32_t index) {
    KeyframeId newest;
    map().keyframes().ForEach([&](KeyframeId id, const Keyframe&) { newest = id; });
    KeyframeRequest request = Request(index, newest);
    auto frame = std::make_shared<Frame>(*request.frame);
    frame->detections = {DetectCup(index)};
    request.frame = std::move(frame);
    Process(request);
  }

  const ObjectLandmark& OnlyObject() const {
    const ObjectLandmark* only = nullptr;
    map().objects().ForEach([&](ObjectId, const ObjectLandmark& object) { only = &object; });
    EXPECT_EQ(map().objects().size(), 1u);
    return *only;
  }

  // Nearer than the points of the world, so that none of them hides it.
  const MadeObject cup_ = MakeObject("cup", {0.2, 0.0, 1.2}, {0.06, 0.10, 0.08});
};

TEST_F(MapperLateMasksTest, LateDetectionsMapTheObjectThatThoseInTimeMap) {
  const MappingOptions options = {.cull_keyframes = false};
  Restart(options);
  ProcessFrame(0);
  for (uint32_t index = 5; index <= 60; index += 5) {
    ProcessWithCup(index);
  }
  const ObjectLandmark in_time = OnlyObject();
  ASSERT_EQ(in_time.state, ObjectState::kMapped);
  Restart(options);
  mapper_->AwaitMasks(true);
  ProcessFrame(0);
  for (uint32_t index = 5; index <= 60; index += 5) {
    ProcessFrame(index);
    ASSERT_TRUE(AddLate(index));
  }
  const ObjectLandmark& late = OnlyObject();
  EXPECT_EQ(late.state, ObjectState::kMapped);
  EXPECT_EQ(late.observations.size(), in_time.observations.size());
  EXPECT_EQ(late.visible, late.found);
  EXPECT_LT((late.ellipsoid.world_from_object.translation -
             in_time.ellipsoid.world_from_object.translation)
                .norm(),
            0.01);
}

TEST_F(MapperLateMasksTest, AKeyframeThatAwaitsMasksDoesNotMissTheObject) {
  ProcessFrame(0);
  for (uint32_t index = 5; index <= 40; index += 5) {
    ProcessWithCup(index);
  }
  const int visible = OnlyObject().visible;
  mapper_->AwaitMasks(true);
  ProcessFrame(45);
  EXPECT_EQ(OnlyObject().visible, visible);
  // Masks that show nothing say that it is not seen.
  EXPECT_TRUE(
      mapper_->Process(LateDetections{.frame = FrameId(45),
                                      .detections = {},
                                      .keypoints = world_.Observe(45).frame->features.size()},
                       nullptr));
  EXPECT_EQ(OnlyObject().visible, visible + 1);
  mapper_->AwaitMasks(false);
  ProcessFrame(50);
  EXPECT_EQ(OnlyObject().visible, visible + 2);
}

TEST_F(MapperLateMasksTest, OnlyAKeyframeWithoutDetectionsTakesThem) {
  mapper_->AwaitMasks(true);
  ProcessFrame(0);
  ProcessFrame(10);
  EXPECT_FALSE(AddLate(5)) << "no keyframe, and no pose to make one";
  EXPECT_TRUE(AddLate(10));
  EXPECT_FALSE(AddLate(10)) << "for the second time";
  LateDetections of_more_keypoints{.frame = FrameId(0), .detections = {DetectCup(0)}};
  EXPECT_FALSE(mapper_->Process(of_more_keypoints, nullptr)) << "the keyframe is compacted";
  EXPECT_EQ(FindViolations(map()), std::vector<std::string>());
}

TEST_F(MapperLateMasksTest, MasksOfAKeyframeThatWasRemovedChangeNothing) {
  mapper_->AwaitMasks(true);
  std::optional<uint32_t> removed;
  for (uint32_t index = 0; index <= 60 && !removed; index += 2) {
    ProcessFrame(index);
    for (uint32_t former = 0; former < index; former += 2) {
      const std::optional<KeyframeId> keyframe = map().KeyframeOfFrame(FrameId(former));
      removed = keyframe && !map().keyframes().Contains(*keyframe) ? former : removed;
    }
  }
  ASSERT_TRUE(removed.has_value());
  EXPECT_FALSE(mapper_->Process(OfTrackedFrame(*removed, {DetectCup(*removed)}), nullptr));
  EXPECT_TRUE(map().objects().empty());
  EXPECT_EQ(FindViolations(map()), std::vector<std::string>());
}

TEST_F(MapperLateMasksTest, AFrameWhoseLateMasksShowAnObjectBecomesAKeyframe) {
  mapper_->AwaitMasks(true);
  ProcessFrame(0);
  ProcessFrame(10);
  EXPECT_FALSE(mapper_->Process(OfTrackedFrame(5, {}), nullptr)) << "it shows no object";
  EXPECT_TRUE(mapper_->Process(OfTrackedFrame(5, {DetectCup(5)}), nullptr));
  EXPECT_FALSE(mapper_->Process(OfTrackedFrame(5, {DetectCup(5)}), nullptr)) << "again";
  const std::optional<KeyframeId> late = map().KeyframeOfFrame(FrameId(5));
  ASSERT_TRUE(late.has_value());
  EXPECT_GT(*late, *map().KeyframeOfFrame(FrameId(10)));
  EXPECT_EQ(map().NextFrame(), FrameId(11));
  EXPECT_EQ(OnlyObject().observations.size(), 1u);
  const Rigid3 error =
      map().keyframes().At(*late).cam_from_world * Inverse(SyntheticWorld::CamFromWorld(5));
  EXPECT_LT(error.translation.norm(), 0.02);
}

// As with masks in time, a keyframe is made only of a frame that shows something new.
TEST_F(MapperLateMasksTest, AFrameThatShowsOnlyMappedObjectsBecomesNoKeyframe) {
  ProcessFrame(0);
  for (uint32_t index = 5; index <= 40; index += 5) {
    ProcessWithCup(index);
  }
  ASSERT_EQ(OnlyObject().state, ObjectState::kMapped);
  mapper_->AwaitMasks(true);
  EXPECT_FALSE(mapper_->Process(OfTrackedFrame(80, {DetectCup(80)}), nullptr));
  EXPECT_TRUE(mapper_->Process(OfTrackedFrame(81, {DetectCup(81), DetectBook(81)}), nullptr))
      << "the book is not mapped";
  EXPECT_EQ(FindViolations(map()), std::vector<std::string>());
}

// A third of a second is ten frames. It does not matter which of the two frames is earlier.
TEST_F(MapperLateMasksTest, AFrameNearAKeyframeWithDetectionsBecomesNoKeyframe) {
  mapper_->AwaitMasks(true);
  ProcessFrame(0);
  ProcessFrame(40);
  ASSERT_TRUE(AddLate(40));
  for (const uint32_t index : {31U, 39U, 41U, 49U}) {
    EXPECT_FALSE(mapper_->Process(OfTrackedFrame(index, {DetectCup(index)}), nullptr)) << index;
  }
  EXPECT_TRUE(mapper_->Process(OfTrackedFrame(51, {DetectCup(51)}), nullptr));
  EXPECT_FALSE(mapper_->Process(OfTrackedFrame(55, {DetectCup(55)}), nullptr)) << "51 is near";
  EXPECT_TRUE(mapper_->Process(OfTrackedFrame(29, {DetectCup(29)}), nullptr));
  EXPECT_TRUE(mapper_->Process(OfTrackedFrame(3, {DetectBook(3)}), nullptr))
      << "keyframe 0 still waits for its masks";
  EXPECT_EQ(FindViolations(map()), std::vector<std::string>());
}

// Something that is never twice at the same place is never mapped.
TEST_F(MapperLateMasksTest, ThingsThatAreNeverMappedMakeFewerAndFewerKeyframes) {
  mapper_->AwaitMasks(true);
  ProcessFrame(0);
  std::vector<uint32_t> made;
  for (uint32_t index = 10; index < 200; ++index) {
    const MadeObject somewhere =
        MakeObject("bird", {0.3 * std::sin(2.0 * index), 0.2 * std::cos(3.0 * index), 1.2},
                   {0.02, 0.03, 0.02});
    const Detection detection =
        Detect(somewhere, world_.sensor(), SyntheticWorld::CamFromWorld(index));
    if (mapper_->Process(OfTrackedFrame(index, {detection}), nullptr)) {
      made.push_back(index);
    }
  }
  ASSERT_GE(made.size(), 5u);
  EXPECT_LE(made.size(), 9u) << "one every 1/3 s would be 19";
  for (size_t i = 2; i < made.size(); ++i) {
    EXPECT_GE(made[i] - made[i - 1], made[i - 1] - made[i - 2]);
  }
}

// Of 60 frames each of which gets masks late, hardly more become keyframes than without masks.
TEST_F(MapperLateMasksTest, MasksOfAllFramesMakeFewKeyframes) {
  mapper_->AwaitMasks(true);
  const uint32_t before = 13;
  for (uint32_t index = 0; index < 60; ++index) {
    if (index % 5 == 0) {
      ProcessFrame(index);
    }
    mapper_->Process(OfTrackedFrame(index, {DetectCup(index), DetectBook(index)}), nullptr);
  }
  EXPECT_LE(map().keyframes().NextId().value, before);
  size_t mapped = 0;
  map().objects().ForEach([&](ObjectId, const ObjectLandmark& object) {
    mapped += object.state == ObjectState::kMapped ? 1 : 0;
  });
  EXPECT_EQ(mapped, 2u);
}

// The detections of the message are those of the image as read.
TEST_F(MapperLateMasksTest, LateDetectionsAreCorrectedAsTheShutterOfTheirFrameWas) {
  Sensor sensor = world_.sensor();
  sensor.readout_time = 0.03;
  const auto corrected = [&](uint32_t index, std::vector<Detection> detections) {
    Frame as_read = *world_.Observe(index).frame;
    as_read.detections = std::move(detections);
    const std::vector<double> inverse_depths(as_read.features.size(), 0.4);
    return WithGlobalShutter(as_read, sensor, {{0.3, -0.8, 0.2}, {0.5, 0.2, -0.1}}, inverse_depths);
  };
  Mapper mapper(sensor, {}, ObjectOptions(), [this](auto map) { published_.push_back(map); });
  mapper.AwaitMasks(true);
  InitialMap initial = Initial(0);
  initial.views[0].frame = corrected(0, {});
  mapper.Process(initial, nullptr);
  const auto expect_corrected = [&](uint32_t index) {
    const Frame expected = *corrected(index, {DetectCup(index)});
    const Frame& frame = *map().keyframes().At(*map().KeyframeOfFrame(FrameId(index))).frame;
    ASSERT_EQ(frame.detections.size(), 1u);
    EXPECT_EQ(frame.detections[0].hull, expected.detections[0].hull);
    EXPECT_NE(frame.detections[0].hull, DetectCup(index).hull);
    EXPECT_EQ(frame.shutter, nullptr) << "it would be corrected again";
  };
  LateDetections of_keyframe = OfTrackedFrame(0, {DetectCup(0)});
  EXPECT_TRUE(mapper.Process(of_keyframe, nullptr));
  expect_corrected(0);
  LateDetections of_frame = OfTrackedFrame(20, {DetectCup(20)});
  of_frame.request->frame = corrected(20, {});
  EXPECT_TRUE(mapper.Process(of_frame, nullptr));
  expect_corrected(20);
}

// The keypoints of the right half of the image are on a thing of a dynamic class.
TEST_F(MapperLateMasksTest, LandmarksOnDynamicThingsAreRemovedWhenTheMasksCome) {
  mapper_->AwaitMasks(true);
  ProcessFrame(0);
  ProcessFrame(10);
  const auto make_dynamic = [&](LateDetections late, const Frame& frame) {
    for (uint32_t i = 0; i < late.keypoints; ++i) {
      if (frame.features.keypoints[i].undistorted.x() > 320.0f) {
        late.dynamic_keypoints.push_back(i);
      }
    }
    return late;
  };
  const auto expect_static_only = [&](FrameId id, size_t dynamic, size_t keypoints) {
    const Keyframe& keyframe = map().keyframes().At(*map().KeyframeOfFrame(id));
    EXPECT_EQ(keyframe.frame->features.size(), keypoints - dynamic);
    for (const Keypoint& keypoint : keyframe.frame->features.keypoints) {
      EXPECT_LE(keypoint.undistorted.x(), 320.0f);
    }
  };
  const std::shared_ptr<const Frame> tracked = world_.Observe(10).frame;
  LateDetections of_keyframe = make_dynamic(OfTrackedFrame(10, {DetectCup(10)}), *tracked);
  const size_t landmarks = map().landmarks().size();
  ASSERT_GT(of_keyframe.dynamic_keypoints.size(), 20u);
  EXPECT_TRUE(mapper_->Process(of_keyframe, nullptr));
  EXPECT_LT(map().landmarks().size(), landmarks);
  expect_static_only(FrameId(10), of_keyframe.dynamic_keypoints.size(), of_keyframe.keypoints);
  Learn();
  const LateDetections of_frame =
      make_dynamic(OfTrackedFrame(30, {DetectCup(30)}), *world_.Observe(30).frame);
  EXPECT_TRUE(mapper_->Process(of_frame, nullptr));
  expect_static_only(FrameId(30), of_frame.dynamic_keypoints.size(), of_frame.keypoints);
}

// A frame that shows only a person, and so becomes no keyframe.
TEST_F(MapperLateMasksTest, LandmarksOnDynamicThingsAreRemovedWithoutAKeyframe) {
  mapper_->AwaitMasks(true);
  ProcessFrame(0);
  ProcessFrame(10);
  LateDetections late = OfTrackedFrame(12, {});
  for (uint32_t i = 0; i < late.keypoints; i += 2) {
    late.dynamic_keypoints.push_back(i);
  }
  EXPECT_FALSE(mapper_->Process(late, nullptr));
  for (size_t i = 0; i < late.request->landmarks.size(); ++i) {
    const LandmarkId landmark = late.request->landmarks[i];
    if (landmark.IsValid()) {
      EXPECT_EQ(map().landmarks().Contains(landmark), i % 2 == 1) << i;
    }
  }
}

TEST_F(MapperTest, ASessionBeginsWithItsFirstKeyframe) {
  MappingOptions options;
  options.final_bundle_adjustment = true;
  SyntheticMap made = MakeSyntheticMap(world_, {0, 5, 10});
  const auto begin = [&] {
    Restart(options);
    mapper_->Begin(made.map.Snapshot(), {"second", FrameId(15)});
    ASSERT_EQ(published_.size(), 1u) << "the map is there before the first message";
  };
  begin();
  FinishMap(*mapper_);
  EXPECT_EQ(published_.size(), 1u) << "a map without new keyframes is not adjusted";
  EXPECT_TRUE(map().sessions().empty());
  begin();
  Process(Request(20, KeyframeId(2)));
  EXPECT_EQ(map().sessions(), (std::vector<Session>{{"second", FrameId(15)}}));
  EXPECT_EQ(map().keyframes().NextId(), KeyframeId(4));
  FinishMap(*mapper_);
  EXPECT_TRUE(mapper_->times().samples().contains("global_bundle_adjustment"));
}

class MapperWithoutMuchDepth : public MapperTest, public testing::WithParamInterface<TestCamera> {
 protected:
  MapperWithoutMuchDepth() : MapperTest({.points = 600, .depth_share = 0.3}, GetParam().sensor) {}
};

HULLSLAM_WITH_ALL_CAMERAS(MapperWithoutMuchDepth);

TEST_P(MapperWithoutMuchDepth, PointsWithoutDepthAreTriangulated) {
  for (uint32_t index = 0; index <= 50; index += 5) {
    ProcessFrame(index);
  }
  size_t triangulated = 0;
  for (const auto& [point, landmark] : landmark_of_point_) {
    if (!world_.has_depth(point)) {
      ++triangulated;
      EXPECT_LT((map().landmarks().At(landmark).position - world_.points()[point]).norm(), 0.01);
    }
  }
  EXPECT_GT(triangulated, 200u);
}

// A monocular camera that looks at a cup. The unit of length of the first map is 2 m.
class MapperKnownSizesTest : public testing::Test {
 protected:
  void Run(const std::map<std::string, double>& sizes, uint32_t last = 160) {
    ObjectOptions objects;
    objects.sizes = sizes;
    mapper_ = std::make_unique<Mapper>(sensor_, MappingOptions{.cull_keyframes = false}, objects,
                                       [this](auto map) { map_ = std::move(map); });
    const std::vector<SyntheticView> views = {View(0), View(10)};
    InitialMap initial;
    for (const SyntheticView& view : views) {
      initial.views.push_back(
          {view.frame, Scaled(SyntheticWorld::CamFromWorld(10.0 * initial.views.size()), 0.5)});
    }
    std::map<uint32_t, std::vector<InitialMap::Observation>> seen;
    for (size_t view = 0; view < views.size(); ++view) {
      for (uint32_t i = 0; i < views[view].points.size(); ++i) {
        seen[views[view].points[i]].push_back({view, i});
      }
    }
    for (const auto& [point, observations] : seen) {
      if (observations.size() == 2) {
        initial.points.push_back({0.5 * world_.points()[point], observations});
      }
    }
    mapper_->Process(initial, nullptr);
    next_ = 20;
    RunOn(last);
  }
  void Load(Map map) {
    mapper_ = std::make_unique<Mapper>(sensor_, MappingOptions(), ObjectOptions(),
                                       [this](auto now) { map_ = std::move(now); });
    mapper_->Begin(std::move(map), {"second", FrameId(1000)});
  }
  void RunOn(uint32_t last) {
    for (; next_ <= last; next_ += 10) {
      Request(next_);
    }
  }

  // The length of the unit of the map, m.
  double Unit() const {
    const auto distance = [](const Rigid3& a, const Rigid3& b) {
      return (Inverse(a).translation - Inverse(b).translation).norm();
    };
    return distance(SyntheticWorld::CamFromWorld(0), SyntheticWorld::CamFromWorld(10)) /
           distance(map_->CamFromWorld(KeyframeId(0)), map_->CamFromWorld(KeyframeId(1)));
  }

  std::unique_ptr<Mapper> mapper_;
  std::shared_ptr<const Map> map_;

 private:
  static Rigid3 Scaled(const Rigid3& pose, double factor) {
    return {pose.rotation, factor * pose.translation};
  }
  SyntheticView View(uint32_t index) const {
    SyntheticView view = world_.Observe(index);
    Frame frame = *view.frame;
    frame.detections.push_back(Detect(cup_, sensor_, SyntheticWorld::CamFromWorld(index)));
    frame.detections.back().points.clear();
    view.frame = std::make_shared<const Frame>(std::move(frame));
    return view;
  }
  // Sends the path's frame `index`, whose keypoints show the landmarks with their descriptors.
  void Request(uint32_t index) {
    std::map<Descriptor, LandmarkId> by_descriptor;
    map_->landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
      by_descriptor.emplace(landmark.descriptor, id);
    });
    const SyntheticView view = View(index);
    KeyframeRequest request;
    request.frame = view.frame;
    request.pose =
        map_->RelativeTo(KeyframeId(0), Scaled(SyntheticWorld::CamFromWorld(index), 1.0 / Unit()));
    for (const uint32_t point : view.points) {
      const auto known = by_descriptor.find(world_.descriptor(point));
      request.landmarks.push_back(known != by_descriptor.end() ? known->second : LandmarkId());
    }
    mapper_->Process(request, nullptr);
  }

  uint32_t next_ = 20;  // frame of the path
  const SyntheticWorld world_{{.points = 400, .depth_share = 0.0}};
  const Sensor sensor_ = [this] {
    Sensor sensor = world_.sensor();
    sensor.kind = SensorKind::kMonocular;
    return sensor;
  }();
  const MadeObject cup_ = MakeObject("cup", {0.0, 0.0, 4.0}, {0.25, 0.40, 0.30});
};

TEST_F(MapperKnownSizesTest, WithoutASizeTheUnitStays) {
  Run({{"book", 0.3}});
  EXPECT_NEAR(Unit(), 2.0, 0.02);
  EXPECT_FALSE(mapper_->times().samples().contains("known_sizes"));
}

TEST_F(MapperKnownSizesTest, ASizeMakesTheUnitTheMetreDuringTheRun) {
  Run({{"cup", 0.8}});
  EXPECT_NEAR(Unit(), 1.0, 0.02);
  EXPECT_EQ(FindViolations(*map_), std::vector<std::string>());
  FinishMap(*mapper_);
  EXPECT_NEAR(Unit(), 1.0, 0.01);
}

TEST_F(MapperKnownSizesTest, ASizeThatIsToldLaterRescalesAtOnceAndTheLastOneCounts) {
  Run({});
  ASSERT_NEAR(Unit(), 2.0, 0.02);
  const auto tell = [&](const ObjectEdit& edit) { mapper_->Process(edit, nullptr); };
  tell({.object = ObjectId(0), .is_locked = true});  // a rescaling moves locked objects too
  tell({.object = ObjectId(0), .known_size = 0.4});
  EXPECT_NEAR(Unit(), 2.0, 0.02) << "as if the cup were half as large";
  const uint32_t corrections = map_->correction_count();
  tell({.object = ObjectId(0), .known_size = 0.8});
  EXPECT_NEAR(Unit(), 1.0, 0.02);
  EXPECT_EQ(map_->correction_count(), corrections + 1);
  EXPECT_NEAR(map_->objects().At(ObjectId(0)).ellipsoid.half_axes.maxCoeff(), 0.4, 0.02);
  EXPECT_EQ(FindViolations(*map_), std::vector<std::string>());
  tell({.object = ObjectId(0), .name = "mine"});
  EXPECT_EQ(map_->correction_count(), corrections + 1);
  tell({.object = ObjectId(0), .known_size = 0.0});
  EXPECT_NEAR(Unit(), 1.0, 0.02) << "the unit stays";
  FinishMap(*mapper_);
  EXPECT_NEAR(Unit(), 1.0, 0.02);
}

TEST_F(MapperKnownSizesTest, AnObjectThatIsNotMappedYetOrDeletedWaits) {
  Run({}, 40);
  ASSERT_TRUE(map_->objects().Contains(ObjectId(0)));
  mapper_->Process(ObjectEdit{.object = ObjectId(0), .known_size = 0.8}, nullptr);
  EXPECT_NEAR(Unit(), 2.0, 0.03) << "it has too few observations";
  RunOn(160);
  EXPECT_NEAR(Unit(), 1.0, 0.03);
  mapper_->Process(ObjectEdit{.object = ObjectId(0), .known_size = 8.0, .is_deleted = true},
                   nullptr);
  EXPECT_NEAR(Unit(), 1.0, 0.03) << "a deleted object says nothing";
}

// Nothing comes after the edit when poses are only localised in a loaded map.
TEST_F(MapperKnownSizesTest, InALoadedMapASizeCountsAtOnce) {
  Run({});
  ASSERT_NEAR(Unit(), 2.0, 0.03);
  Map few = mapper_->Snapshot();
  for (uint32_t i = 8; i < few.keyframes().NextId().value; ++i) {
    few.RemoveObservation(ObjectId(0), KeyframeId(i));
  }
  Load(std::move(few));
  mapper_->Process(ObjectEdit{.object = ObjectId(0), .known_size = 0.8}, nullptr);
  EXPECT_NEAR(Unit(), 1.0, 0.03);
  EXPECT_FALSE(mapper_->HasChangedMap());
}

TEST_F(MapperTest, AnEditReachesTheObjectThatReplacedItsOwn) {
  Map map;
  const auto frame = std::make_shared<Frame>();
  frame->id = FrameId(0);
  frame->detections.resize(2);
  map.AddKeyframe(frame, {});
  const ObjectId old = map.AddObject();
  const ObjectId kept = map.AddObject();
  map.AddObservation(old, KeyframeId(0), 0);
  map.ReplaceObject(old, kept);
  std::shared_ptr<const Map> published;
  const Sensor sensor;
  Mapper mapper(sensor, {}, {}, [&](std::shared_ptr<const Map> now) { published = now; });
  mapper.Begin(std::move(map), {"second", FrameId(1)});
  EXPECT_TRUE(mapper.Process(ObjectEdit{.object = old, .name = "cup"}, nullptr));
  EXPECT_TRUE(mapper.Process(ObjectEdit{.object = old, .is_locked = true}, nullptr));
  EXPECT_EQ(published->objects().At(kept).name, "cup");
  EXPECT_TRUE(published->objects().At(kept).is_locked);
  EXPECT_FALSE(mapper.HasChangedMap()) << "there is no new session without a keyframe";
  EXPECT_TRUE(mapper.Process(ObjectEdit{.object = old, .is_deleted = true}, nullptr));
  EXPECT_TRUE(published->objects().empty());
  EXPECT_FALSE(published->keyframes().At(KeyframeId(0)).objects[0].IsValid());
  EXPECT_FALSE(mapper.Process(ObjectEdit{.object = old, .name = "late"}, nullptr));
}

}  // namespace
}  // namespace hullslam
