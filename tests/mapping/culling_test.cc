// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/culling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <utility>
#include <vector>

#include "map/keyframe_graph.h"
#include "map/landmark_edits.h"
#include "map/made_map.h"
#include "map_files/invariants.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

constexpr int kWall = 2000;  // mm
constexpr int kNear = 500;
constexpr uint32_t kShared = 20;  // landmarks on the wall, so that all keyframes are covisible

cv::Mat Depth(int millimetres) { return {480, 640, CV_16UC1, cv::Scalar(millimetres)}; }

// A camera at the world's origin has seen a thing 1 m ahead in seven keyframes.
class ContradictedLandmarks : public testing::Test {
 protected:
  ContradictedLandmarks() {
    for (int i = 0; i < 7; ++i) {
      last_ = Look(Depth(1000), Rigid3());
    }
    for (uint32_t i = 0; i < kShared; ++i) {
      AddLandmark({0.5, 0.0, 2.0}, i);
    }
    thing_ = AddLandmark({0.0, 0.0, 1.0}, kShared);
    for (uint32_t i = 0; i <= last_.value; ++i) {
      UpdateCovisibility(map_, KeyframeId(i));
    }
  }

  LandmarkId AddLandmark(const Eigen::Vector3d& position, uint32_t keypoint) {
    const LandmarkId id = map_.AddLandmark(position, KeyframeId(0));
    map_.keyframes().ForEach([&](KeyframeId keyframe, const Keyframe&) {
      EXPECT_TRUE(map_.AddObservation(id, keyframe, keypoint));
    });
    UpdateViewingGeometry(map_, id, sensor_.levels);
    return id;
  }

  KeyframeId Look(const cv::Mat& depth, const Rigid3& cam_from_world) {
    const std::shared_ptr<Frame> frame = MakeFrame(next_frame_++, kShared + 1, kShared + 1);
    frame->depth = DepthGrid(depth, 1000.0);
    return map_.AddKeyframe(frame, cam_from_world);
  }

  // A keyframe that observes the wall, and the thing if `is_found`. Returns how many landmarks are
  // removed after it.
  size_t See(const cv::Mat& depth, bool is_found = false, const Rigid3& cam_from_world = {}) {
    const KeyframeId id = Look(depth, cam_from_world);
    for (uint32_t i = 0; i < kShared; ++i) {
      map_.AddObservation(map_.keyframes().At(last_).landmarks[i], id, i);
    }
    if (is_found) {
      map_.AddObservation(thing_, id, kShared);
    }
    UpdateCovisibility(map_, id);
    const size_t erased = EraseContradictedLandmarks(map_, id, sensor_, contradictions_);
    EXPECT_EQ(FindViolations(map_), std::vector<std::string>());
    return erased;
  }
  bool IsThere() const { return map_.landmarks().Contains(thing_); }

  const Sensor sensor_ = SyntheticSensor();
  Map map_;
  Contradictions<LandmarkId> contradictions_;
  uint32_t next_frame_ = 0;
  KeyframeId last_;
  LandmarkId thing_;
};

TEST_F(ContradictedLandmarks, GoWhenThreeKeyframesSeeWhatIsBehind) {
  EXPECT_EQ(See(Depth(kWall)), 0U);
  EXPECT_EQ(See(Depth(kWall)), 0U);
  EXPECT_TRUE(IsThere());
  EXPECT_EQ(See(Depth(kWall)), 1U) << "seven observations do not matter any more";
  EXPECT_FALSE(IsThere());
  EXPECT_EQ(map_.landmarks().size(), kShared) << "what is observed stays";
}

TEST_F(ContradictedLandmarks, StayBehindSomethingNearerOrWithoutDepth) {
  cv::Mat hole = Depth(kWall);
  hole(cv::Rect(320, 240, 8, 8)) = 0;
  for (const cv::Mat& depth : {Depth(kNear), Depth(0), hole, cv::Mat()}) {
    for (int i = 0; i < 5; ++i) {
      EXPECT_EQ(See(depth), 0U);
    }
  }
  EXPECT_TRUE(IsThere());
}

TEST_F(ContradictedLandmarks, AnOccluderBetweenContradictionsChangesNothing) {
  See(Depth(kWall));
  See(Depth(kNear));
  See(Depth(kWall));
  EXPECT_TRUE(IsThere());
  See(Depth(kNear));
  EXPECT_TRUE(IsThere()) << "the newest keyframe does not contradict it";
  EXPECT_EQ(See(Depth(kWall)), 1U);
}

// Late masks make a keyframe of a frame that was taken before the thing was seen last.
TEST_F(ContradictedLandmarks, AFrameBeforeTheLastObservationSaysNothing) {
  See(Depth(kWall));
  See(Depth(kWall));
  next_frame_ = 100;
  See(Depth(1000), true);
  for (const uint32_t frame : {50U, 60U, 70U, 80U}) {
    next_frame_ = frame;
    EXPECT_EQ(See(Depth(kWall)), 0U);
  }
  next_frame_ = 101;
  EXPECT_EQ(See(Depth(kWall)), 0U);
  next_frame_ = 102;
  EXPECT_EQ(See(Depth(kWall)), 0U);
  next_frame_ = 103;
  EXPECT_EQ(See(Depth(kWall)), 1U) << "three frames after it";
}

// In a place that is mapped well, keyframes are culled soon.
TEST_F(ContradictedLandmarks, KeyframesThatWereCulledStillCount) {
  See(Depth(kWall));
  See(Depth(kWall));
  map_.CullKeyframe(KeyframeId(last_.value + 1));
  map_.CullKeyframe(KeyframeId(last_.value + 2));
  EXPECT_EQ(See(Depth(kWall)), 1U);
}

// The pixel beside the border of a thing shows what is behind it.
TEST_F(ContradictedLandmarks, StayBesideASurfaceAtTheirDepth) {
  cv::Mat border = Depth(kWall);
  border(cv::Rect(0, 0, 313, 480)) = 1000;  // the landmark is at column 320
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(See(border), 0U);
  }
  border = Depth(kWall);
  border(cv::Rect(0, 0, 300, 480)) = 1000;
  See(border);
  See(border);
  EXPECT_EQ(See(border), 1U);
}

TEST_F(ContradictedLandmarks, ContradictionsCountAnewAfterASightOfThem) {
  for (const bool is_found : {false, true}) {
    See(Depth(kWall));
    See(Depth(kWall));
    EXPECT_EQ(See(is_found ? Depth(kWall) : Depth(1000), is_found), 0U);
  }
  See(Depth(kWall));
  EXPECT_EQ(See(Depth(kWall)), 0U);
  EXPECT_EQ(See(Depth(kWall)), 1U);
}

// bf is 40 px m and the error of both disparities 1 px, so that of their difference is sqrt(2), and
// the 95 % quantile is 2.77 px: the bound is at 40 / (40 - 2.77) = 1.074 m.
TEST_F(ContradictedLandmarks, StayWithinTheErrorOfDepth) {
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(See(Depth(1070)), 0U);
  }
  const Map before = map_.Snapshot();
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(See(Depth(1079)), 0U);
  }
  EXPECT_EQ(See(Depth(1079)), 1U);
  EXPECT_TRUE(before.landmarks().Contains(thing_));
}

// A keyframe that would not recognise the landmark says nothing about it.
TEST_F(ContradictedLandmarks, StayWhereTheyCannotBeRecognised) {
  const Rigid3 from_behind(
      Eigen::Quaterniond(Eigen::AngleAxisd(3.14159265, Eigen::Vector3d::UnitY())), {0.0, 0.0, 2.0});
  const Rigid3 far_away(Eigen::Quaterniond::Identity(), {0.0, 0.0, 9.0});
  const Rigid3 aside(Eigen::Quaterniond::Identity(), {5.0, 0.0, 0.0});
  for (const Rigid3& pose : {from_behind, far_away, aside}) {
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(See(Depth(60000), false, pose), 0U);
    }
  }
  EXPECT_TRUE(IsThere());
}

// Keyframes with many keypoints with depth, which can observe landmarks.
class RecentLandmarksTest : public testing::Test {
 protected:
  RecentLandmarksTest() {
    for (uint32_t i = 0; i < 5; ++i) {
      map_.AddKeyframe(world_.Observe(i).frame, SyntheticWorld::CamFromWorld(i));
      if (i > 0) {
        SetParent(map_, KeyframeId(i), KeyframeId(0));
      }
    }
  }

  // Adds a landmark that keyframe `by` made and that `observers` keyframes from `by` on observe.
  LandmarkId Add(uint32_t by, uint32_t observers, int visible, int found) {
    const LandmarkId id = map_.AddLandmark(Eigen::Vector3d(0.0, 0.0, 3.0), KeyframeId(by));
    for (uint32_t i = 0; i < observers; ++i) {
      EXPECT_TRUE(map_.AddObservation(id, KeyframeId(by + i), next_keypoint_));
    }
    ++next_keypoint_;
    map_.CountSightings(id, visible - 1, found - 1);
    return id;
  }

  void ExpectCulled(LandmarkId id, uint32_t current, const std::string& what) {
    std::vector<LandmarkId> recent = {id};
    CullRecentLandmarks(map_, KeyframeId(current), sensor_, recent);
    EXPECT_FALSE(map_.landmarks().Contains(id)) << what;
    EXPECT_TRUE(recent.empty()) << what;
    EXPECT_EQ(FindViolations(map_), std::vector<std::string>());
  }
  void ExpectKept(LandmarkId id, uint32_t current, bool on_trial, const std::string& what) {
    std::vector<LandmarkId> recent = {id};
    CullRecentLandmarks(map_, KeyframeId(current), sensor_, recent);
    EXPECT_TRUE(map_.landmarks().Contains(id)) << what;
    EXPECT_EQ(recent.size(), on_trial ? 1u : 0u) << what;
  }

  const SyntheticWorld world_{{.points = 300}};
  Sensor sensor_ = world_.sensor();
  Map map_;
  uint32_t next_keypoint_ = 0;
};

TEST_F(RecentLandmarksTest, AreErasedIfFoundInLessThanAQuarterOfTheFrames) {
  ExpectKept(Add(0, 3, 100, 25), 1, true, "exactly a quarter");
  ExpectCulled(Add(0, 3, 100, 24), 1, "below a quarter");
  ExpectCulled(Add(0, 3, 100, 24), 4, "below a quarter, old");
}

TEST_F(RecentLandmarksTest, AreErasedIfTheirWeightIsSmallAfterTwoKeyframes) {
  ExpectKept(Add(1, 1, 1, 1), 2, true, "one observation, one keyframe later");
  ExpectCulled(Add(1, 1, 1, 1), 3, "one observation with depth, two keyframes later");
  ExpectKept(Add(1, 2, 1, 1), 3, true, "two observations with depth are enough");
}

TEST_F(RecentLandmarksTest, OfAnotherIslandStayAndAreNotCheckedAgain) {
  const LandmarkId id = Add(1, 1, 100, 1);
  DetachFromTree(map_, KeyframeId(4));
  map_.MoveToIsland(KeyframeId(4), map_.BeginIsland());
  ExpectKept(id, 4, false, "the camera cannot see it any more");
  ExpectCulled(id, 3, "the camera could see it");
}

// In monocular maps every observation has the weight 1, and three observations are needed.
TEST_F(RecentLandmarksTest, OfAMonocularCameraNeedThreeObservations) {
  const LandmarkId three = Add(0, 2, 1, 1);  // weight 4
  sensor_.kind = SensorKind::kMonocular;
  ExpectKept(three, 3, false, "weight 4");
  const LandmarkId weak = Add(0, 1, 1, 1);  // weight 2
  ExpectCulled(weak, 2, "weight 2");
}

TEST_F(RecentLandmarksTest, LeaveTheListAfterThreeKeyframes) {
  ExpectKept(Add(1, 2, 1, 1), 3, true, "two keyframes later");
  ExpectKept(Add(1, 2, 1, 1), 4, false, "three keyframes later");
}

TEST_F(RecentLandmarksTest, ThatNoLongerExistLeaveTheList) {
  const LandmarkId gone = Add(0, 2, 1, 1);
  const LandmarkId replaced = Add(0, 2, 1, 1);
  const LandmarkId by = Add(0, 2, 1, 1);
  map_.EraseLandmark(gone);
  map_.ReplaceLandmark(replaced, by);
  std::vector<LandmarkId> recent = {gone, replaced, by};
  CullRecentLandmarks(map_, KeyframeId(0), sensor_, recent);
  EXPECT_EQ(recent, std::vector{by});
}

// Late masks make a keyframe of a frame before the landmarks were made. Nothing is older then, and
// a landmark that this keyframe makes is as old as the keyframes after it say.
TEST_F(RecentLandmarksTest, AreNoOlderAfterAKeyframeOfAnEarlierFrame) {
  map_.AddKeyframe(MakeFrame(20, 300, 300), Rigid3());  // keyframe 5
  SetParent(map_, KeyframeId(5), KeyframeId(0));
  const LandmarkId weak = map_.AddLandmark({0.0, 0.0, 3.0}, KeyframeId(5));
  map_.AddObservation(weak, KeyframeId(5), 0);
  for (const uint32_t frame : {10U, 11U, 12U}) {
    const KeyframeId late = map_.AddKeyframe(MakeFrame(frame, 300, 300), Rigid3());
    SetParent(map_, late, KeyframeId(0));
    ExpectKept(weak, late.value, true, "a keyframe of an earlier frame");
  }
  const LandmarkId of_late = map_.AddLandmark({0.0, 0.0, 3.0}, KeyframeId(8));
  map_.AddObservation(of_late, KeyframeId(8), 0);
  map_.AddKeyframe(MakeFrame(30, 300, 300), Rigid3());  // keyframe 9
  SetParent(map_, KeyframeId(9), KeyframeId(0));
  ExpectKept(weak, 9, true, "one keyframe later");
  ExpectKept(of_late, 9, true, "one keyframe later");
  EXPECT_EQ(FindRecentLandmarks(map_), (std::vector<LandmarkId>{weak, of_late}));
  map_.AddKeyframe(MakeFrame(31, 300, 300), Rigid3());  // keyframe 10
  SetParent(map_, KeyframeId(10), KeyframeId(0));
  ExpectCulled(weak, 10, "two keyframes later");
  ExpectCulled(of_late, 10, "two keyframes later");
}

// A camera comes back to one view every two minutes. A keyframe shows what is at five points there,
// by one landmark for each light in which the points look different.
class ForgottenLandmarks : public testing::Test {
 protected:
  static constexpr size_t kPoints = 5;
  using Look = std::vector<LandmarkId>;

  ForgottenLandmarks() { keyframe_ = map_.AddKeyframe(MakeFrame(0, 100, 100), Rigid3()); }

  // Landmarks of the points as they look in a new light, or of a thing in front of them.
  Look AddLook(double depth = 2.0) {
    Look look;
    for (size_t i = 0; i < kPoints; ++i) {
      const Eigen::Vector3d ray(0.1 * static_cast<double>(i), 0.0, 1.0 + 1e-4 * keypoint_);
      const Eigen::Vector3d position = depth * ray;
      look.push_back(map_.AddLandmark(position, keyframe_));
      EXPECT_TRUE(map_.AddObservation(look.back(), keyframe_, keypoint_++));
      UpdateViewingGeometry(map_, look.back(), sensor_.levels);
    }
    return look;
  }

  // Visits in which `seen` is found in a share of the 100 frames and the other landmarks in none.
  // Returns how many landmarks are removed.
  size_t Visit(int times, const Look& seen, int found = 100) {
    size_t removed = 0;
    for (int i = 0; i < times; ++i) {
      visits_.Add(map_, {}, time_ += 110.0);  // elsewhere
      removed += GoOn(seen, found);
    }
    return removed;
  }
  // Ten seconds more of the same visit.
  size_t GoOn(const Look& seen, int found = 100) {
    std::vector<Sighting> sightings;
    map_.landmarks().ForEach([&](LandmarkId id, const Landmark&) {
      sightings.push_back({id, 100, std::ranges::count(seen, id) > 0 ? found : 0});
    });
    visits_.Add(map_, sightings, time_ += 10.0);
    const size_t removed = EraseForgottenLandmarks(map_, keyframe_, sensor_, visits_);
    EXPECT_EQ(FindViolations(map_), std::vector<std::string>());
    return removed;
  }
  bool AreThere(const Look& look) const {
    return std::ranges::all_of(look, [&](LandmarkId id) { return map_.landmarks().Contains(id); });
  }

  const Sensor sensor_ = SyntheticSensor();
  Map map_;
  LandmarkVisits visits_;
  KeyframeId keyframe_;
  uint32_t keypoint_ = 0;
  double time_ = 0.0;
};

TEST_F(ForgottenLandmarks, OfThreeLightsTheTwoSeenLastStay) {
  const Look day = AddLook();
  EXPECT_EQ(Visit(6, day), 0U);
  const Look lamp = AddLook();
  EXPECT_EQ(Visit(6, lamp), 0U);
  EXPECT_EQ(Visit(6, day), 0U) << "the same by day and by lamp";
  EXPECT_EQ(Visit(6, lamp), 0U);
  EXPECT_EQ(Visit(6, day), 0U);
  const Look sunset = AddLook();
  EXPECT_EQ(Visit(6, sunset), kPoints);
  EXPECT_FALSE(AreThere(lamp)) << "seen longest ago";
  EXPECT_TRUE(AreThere(day));
  EXPECT_TRUE(AreThere(sunset));
}

TEST_F(ForgottenLandmarks, AreNotThoseThatOneLongVisitHides) {
  const Look look = AddLook();
  Visit(1, look);
  Visit(1, {});
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(GoOn({}), 0U);
  }
  EXPECT_EQ(Visit(5, {}), 0U) << "nor those that are hidden a few times";
  EXPECT_EQ(Visit(3, AddLook(1.5)), 0U) << "by one thing after the other";
  EXPECT_EQ(Visit(3, AddLook(1.5)), 0U);
  EXPECT_TRUE(AreThere(look));
}

TEST_F(ForgottenLandmarks, WereMissedInEightVisitsForEachThatFoundThem) {
  const Look once = AddLook();
  Visit(1, once);
  const Look often = AddLook();
  EXPECT_EQ(Visit(15, often), 0U);
  EXPECT_EQ(Visit(1, often), kPoints);
  EXPECT_FALSE(AreThere(once));
  EXPECT_EQ(Visit(16 * 8 + 7, often, 5), 0U) << "so few frames are a mistake";
  EXPECT_TRUE(AreThere(often));
  EXPECT_EQ(Visit(1, often, 5), kPoints);
}

TEST_F(ForgottenLandmarks, AreNotThoseThatAreOutOfView) {
  const Look look = AddLook();
  map_.SetPose(keyframe_, {Eigen::Quaterniond(0.0, 0.0, 1.0, 0.0), Eigen::Vector3d::Zero()});
  EXPECT_EQ(Visit(100, {}), 0U);
  map_.SetPose(keyframe_, Rigid3());
  EXPECT_EQ(Visit(1, {}), kPoints);
  EXPECT_FALSE(AreThere(look));
}

constexpr size_t kMinObjectViews = 3;

int Cull(Map& map, KeyframeId current, const Sensor& sensor) {
  return CullKeyframes(map, current, sensor, kMinObjectViews);
}

// Keyframes so close together that they see the same points at the same levels. Each has a
// detection, which shows no object yet. Keyframe i is i * `step` metres to the right of the first.
SyntheticMap NearbyKeyframes(const SyntheticWorld& world, uint32_t count, double step = 0.0) {
  SyntheticMap made;
  std::vector<LandmarkId>& landmarks = made.landmarks;
  landmarks.resize(world.points().size());
  for (uint32_t i = 0; i < count; ++i) {
    const Rigid3 cam_from_world(Eigen::Quaterniond::Identity(), {-step * i, 0.0, 0.0});
    const SyntheticView view = world.Observe(FrameId(i), cam_from_world);
    auto frame = std::make_shared<Frame>(*view.frame);
    frame->detections.emplace_back().label = "cup";
    const KeyframeId id = made.map.AddKeyframe(frame, cam_from_world);
    for (uint32_t k = 0; k < view.points.size(); ++k) {
      LandmarkId& landmark = landmarks[view.points[k]];
      if (!landmark.IsValid()) {
        landmark = made.map.AddLandmark(world.points()[view.points[k]], id);
      }
      made.map.AddObservation(landmark, id, k);
    }
    UpdateCovisibility(made.map, id);
    made.views.push_back(view);
  }
  return made;
}

TEST(CullKeyframes, RemovesKeyframesWhileFourOthersSeeTheirLandmarks) {
  const SyntheticWorld world;
  SyntheticMap made = NearbyKeyframes(world, 6);
  const auto landmarks = made.map.landmarks().size();
  EXPECT_EQ(Cull(made.map, KeyframeId(5), world.sensor()), 2);
  EXPECT_EQ(FindViolations(made.map), std::vector<std::string>());
  EXPECT_FALSE(made.map.keyframes().Contains(KeyframeId(1)));
  EXPECT_FALSE(made.map.keyframes().Contains(KeyframeId(2)));
  EXPECT_TRUE(made.map.keyframes().Contains(KeyframeId(3))) << "three others are left";
  EXPECT_EQ(made.map.landmarks().size(), landmarks) << "no landmark is erased with it";
}

TEST(CullKeyframes, KeepsTheRootAndTheCurrentKeyframe) {
  const SyntheticWorld world;
  SyntheticMap made = NearbyKeyframes(world, 8);
  EXPECT_EQ(Cull(made.map, KeyframeId(7), world.sensor()), 4);
  EXPECT_EQ(FindViolations(made.map), std::vector<std::string>());
  EXPECT_TRUE(made.map.keyframes().Contains(KeyframeId(0)));
  EXPECT_TRUE(made.map.keyframes().Contains(KeyframeId(7)));
}

TEST(CullKeyframes, RemovesNoneOfThreeKeyframes) {
  const SyntheticWorld world;
  SyntheticMap made = NearbyKeyframes(world, 3);
  EXPECT_EQ(Cull(made.map, KeyframeId(2), world.sensor()), 0);
}

// In a monocular map, landmarks that are seen from a third viewpoint carry the scale from one pair
// of keyframes to the next. Keyframes at the viewpoints of others cannot replace such a keyframe.
TEST(CullKeyframes, MonocularKeyframesAtTheSameViewpointCountOnce) {
  const SyntheticWorld world({.points = 1200, .depth_share = 0.0});
  Sensor sensor = world.sensor();
  sensor.kind = SensorKind::kMonocular;
  SyntheticMap apart = NearbyKeyframes(world, 8, 0.03);
  EXPECT_EQ(Cull(apart.map, KeyframeId(7), sensor), 4) << "four others are left";
  EXPECT_EQ(FindViolations(apart.map), std::vector<std::string>());
  SyntheticMap together = NearbyKeyframes(world, 8, 0.001);
  EXPECT_EQ(Cull(together.map, KeyframeId(7), sensor), 0);
  sensor.kind = SensorKind::kRgbd;
  EXPECT_EQ(Cull(together.map, KeyframeId(7), sensor), 4) << "with depth all count";
}

// Removes the observations of the landmarks of keyframe `id` by the keyframes from `first` on.
// Landmarks that `keep` selects by their depth keep their observations.
void SeeAlone(SyntheticMap& made, KeyframeId id, uint32_t first,
              const std::function<bool(double)>& keep) {
  const Keyframe keyframe = made.map.keyframes().At(id);
  for (size_t i = 0; i < keyframe.landmarks.size(); ++i) {
    if (keep(static_cast<double>(keyframe.frame->features.depth[i]))) {
      continue;
    }
    for (uint32_t other = first; other < made.map.keyframes().NextId().value; ++other) {
      const std::vector<LandmarkId>& seen = made.map.keyframes().At(KeyframeId(other)).landmarks;
      if (std::find(seen.begin(), seen.end(), keyframe.landmarks[i]) != seen.end()) {
        made.map.RemoveObservation(keyframe.landmarks[i], KeyframeId(other));
      }
    }
  }
}

TEST(CullKeyframes, ManyCloseLandmarksAreJudgedAlone) {
  const SyntheticWorld world({.points = 1200});
  SyntheticMap made = NearbyKeyframes(world, 5);
  SeeAlone(made, KeyframeId(1), 2, [&](double depth) { return depth <= 3.2; });
  Cull(made.map, KeyframeId(4), world.sensor());
  EXPECT_FALSE(made.map.keyframes().Contains(KeyframeId(1)));
}

TEST(CullKeyframes, FewCloseLandmarksAreJudgedTogetherWithFarOnes) {
  const SyntheticWorld world({.points = 1200});
  Sensor sensor = world.sensor();
  sensor.close_depth = 2.2;
  SyntheticMap made = NearbyKeyframes(world, 5);
  SeeAlone(made, KeyframeId(1), 2, [&](double depth) { return depth <= sensor.close_depth; });
  const size_t landmarks = made.map.landmarks().size();
  Cull(made.map, KeyframeId(4), sensor);
  EXPECT_TRUE(made.map.keyframes().Contains(KeyframeId(1))) << "it alone sees the far ones";
  EXPECT_EQ(made.map.landmarks().size(), landmarks);

  SyntheticMap far = NearbyKeyframes(world, 5);
  sensor.close_depth = 0.5;
  EXPECT_EQ(Cull(far.map, KeyframeId(4), sensor), 1) << "none is close, but others see all of them";
}

TEST(CullKeyframes, FewCloseLandmarksThatAreSeenAloneKeepAKeyframe) {
  const SyntheticWorld world({.points = 1200});
  Sensor sensor = world.sensor();
  sensor.close_depth = 2.2;
  SyntheticMap made = NearbyKeyframes(world, 5);
  SeeAlone(made, KeyframeId(1), 2, [&](double depth) { return depth > sensor.close_depth; });
  Cull(made.map, KeyframeId(4), sensor);
  EXPECT_TRUE(made.map.keyframes().Contains(KeyframeId(1)));
}

// ORB-SLAM2 judges a keyframe with depth by its close landmarks alone, and objects need no views.
TEST(CullKeyframes, ByTheRuleOfOrbSlam2OnlyCloseLandmarksCount) {
  const SyntheticWorld world({.points = 1200});
  Sensor sensor = world.sensor();
  sensor.close_depth = 2.2;
  SyntheticMap made = NearbyKeyframes(world, 5);
  SeeAlone(made, KeyframeId(1), 2, [&](double depth) { return depth <= sensor.close_depth; });
  const ObjectId object = made.map.AddObject();
  ASSERT_TRUE(made.map.AddObservation(object, KeyframeId(1), 0));
  CullKeyframes(made.map, KeyframeId(4), sensor, kMinObjectViews, MappingRule::kOrbSlam2);
  EXPECT_FALSE(made.map.keyframes().Contains(KeyframeId(1)));

  SyntheticMap held = NearbyKeyframes(world, 5);
  SeeAlone(held, KeyframeId(1), 2, [&](double depth) { return depth <= sensor.close_depth; });
  ObjectLandmark& locked = held.map.MutableObject(held.map.AddObject());
  locked.state = ObjectState::kMapped;
  locked.is_locked = true;
  ASSERT_TRUE(held.map.AddObservation(ObjectId(0), KeyframeId(1), 0));
  CullKeyframes(held.map, KeyframeId(4), sensor, kMinObjectViews, MappingRule::kOrbSlam2);
  EXPECT_TRUE(held.map.keyframes().Contains(KeyframeId(1))) << "the last view of a locked object";

  SyntheticMap far = NearbyKeyframes(world, 5);
  sensor.close_depth = 0.5;
  EXPECT_EQ(CullKeyframes(far.map, KeyframeId(4), sensor, 3, MappingRule::kOrbSlam2), 0)
      << "none is close";
}

TEST(CullKeyframes, ByTheRuleOfOrbSlam2MonocularViewpointsAreNotCompared) {
  const SyntheticWorld world({.points = 1200, .depth_share = 0.0});
  Sensor sensor = world.sensor();
  sensor.kind = SensorKind::kMonocular;
  SyntheticMap together = NearbyKeyframes(world, 8, 0.001);
  EXPECT_EQ(CullKeyframes(together.map, KeyframeId(7), sensor, 3, MappingRule::kOrbSlam2), 5);
}

// In which order and with which others the keyframes of a passage are made.
enum class Making { kInTime, kMiddleLate, kWithOtherIsland };

// Keyframes 0 to 3 see one side of a passage, the last four the other one, and the middle one sees
// both. They all see `across` landmarks. The others stay, because each of them is needed by an
// object. `middle` is the middle one.
Map PassageBetweenTwoSides(int across, Making making, KeyframeId& middle) {
  Map map;
  std::vector<KeyframeId> ids;
  const auto add_elsewhere = [&](uint32_t frame) {
    if (making == Making::kWithOtherIsland) {
      map.AddKeyframe(MakeFrame(frame, 10), Rigid3(), IslandId(1));
    }
  };
  for (uint32_t i = 0; i < 9; ++i) {
    if (making == Making::kMiddleLate && i == 4) {
      continue;
    }
    add_elsewhere(3 * i + 1);
    ids.push_back(map.AddKeyframe(MakeFrame(3 * i, 300, 300), Rigid3()));
    add_elsewhere(3 * i + 2);
  }
  if (making == Making::kMiddleLate) {
    ids.insert(ids.begin() + 4, map.AddKeyframe(MakeFrame(12, 300, 300), Rigid3()));
  }
  middle = ids[4];
  Share(map, {ids.begin(), ids.begin() + 5}, 60);
  Share(map, {ids.begin() + 4, ids.end()}, 60);
  Share(map, ids, across);
  for (const KeyframeId id : ids) {
    UpdateCovisibility(map, id);
    if (id != ids[4]) {
      EXPECT_TRUE(map.AddObservation(map.AddObject(), id, 0));
    }
  }
  return map;
}

// Four others see each of its landmarks, but none of them sees both sides.
TEST(CullKeyframes, AKeyframeThatJoinsItsNeighboursStays) {
  for (const Making making : {Making::kInTime, Making::kMiddleLate, Making::kWithOtherIsland}) {
    const auto is_culled = [&](int across) {
      KeyframeId middle;
      Map map = PassageBetweenTwoSides(across, making, middle);
      const size_t before = map.keyframes().size();
      Cull(map, *map.KeyframeOfFrame(FrameId(24)), SyntheticSensor());
      const bool is_there = map.keyframes().Contains(middle);
      EXPECT_EQ(map.keyframes().size(), is_there ? before : before - 1);
      return !is_there;
    };
    EXPECT_FALSE(is_culled(0)) << static_cast<int>(making);
    EXPECT_FALSE(is_culled(99)) << static_cast<int>(making);
    EXPECT_TRUE(is_culled(100)) << static_cast<int>(making);
  }
}

TEST(CullKeyframes, AFewLandmarksAreNoReasonForCulling) {
  const SyntheticWorld many({.points = 70});
  const SyntheticWorld few({.points = 20});
  SyntheticMap enough = NearbyKeyframes(many, 5);
  SyntheticMap too_few = NearbyKeyframes(few, 5);
  ASSERT_GE(enough.map.landmarks().size(), 20u);
  ASSERT_LT(too_few.map.landmarks().size(), 20u);
  ASSERT_GT(too_few.map.landmarks().size(), 0u);
  EXPECT_EQ(Cull(enough.map, KeyframeId(4), many.sensor()), 1);
  EXPECT_EQ(Cull(too_few.map, KeyframeId(4), few.sensor()), 0);
}

TEST(CullKeyframes, AnObjectKeepsTheViewsThatItNeeds) {
  const SyntheticWorld world;
  for (const uint32_t views : {2U, 3U, 4U}) {
    SyntheticMap made = NearbyKeyframes(world, 8);
    const ObjectId object = made.map.AddObject();
    for (uint32_t i = 1; i <= views; ++i) {
      ASSERT_TRUE(made.map.AddObservation(object, KeyframeId(i), 0));
    }
    Cull(made.map, KeyframeId(7), world.sensor());
    EXPECT_EQ(FindViolations(made.map), std::vector<std::string>());
    EXPECT_EQ(made.map.objects().At(object).observations.size(), std::min(views, 3U));
    EXPECT_FALSE(made.map.keyframes().Contains(KeyframeId(6))) << "it sees no object";
  }
}

TEST(CullKeyframes, AnObjectKeepsAViewFromANewDirection) {
  const SyntheticWorld world({.points = 1500});
  const auto views_left = [&](double distance, bool is_mapped) {
    SyntheticMap made = NearbyKeyframes(world, 8, 0.02);
    const ObjectId id = made.map.AddObject();
    for (uint32_t i = 1; i <= 6; ++i) {
      EXPECT_TRUE(made.map.AddObservation(id, KeyframeId(i), 0));
    }
    ObjectLandmark& object = made.map.MutableObject(id);
    object.has_shape = is_mapped;
    object.ellipsoid.world_from_object.translation = {0.07, 0.0, distance};
    Cull(made.map, KeyframeId(7), world.sensor());
    return made.map.objects().At(id).observations.size();
  };
  EXPECT_EQ(views_left(0.08, true), 6u) << "more than 11 degrees between the views";
  EXPECT_EQ(views_left(3.0, true), 3u);
  EXPECT_EQ(views_left(0.08, false), 3u)
      << "without shape and depth nothing is known of directions";
}

TEST(CullKeyframes, MoreThanNineTenthsMustBeSeenByOthers) {
  const SyntheticWorld world({.points = 1200});
  const auto is_culled_with_share_alone = [&](double share) {
    SyntheticMap made = NearbyKeyframes(world, 5);
    const Keyframe keyframe = made.map.keyframes().At(KeyframeId(1));
    const std::vector<float>& depth = keyframe.frame->features.depth;
    std::vector<LandmarkId> close;
    for (size_t i = 0; i < depth.size(); ++i) {
      if (depth[i] > 0.0f && static_cast<double>(depth[i]) <= world.sensor().close_depth) {
        close.push_back(keyframe.landmarks[i]);
      }
    }
    const auto alone = static_cast<size_t>(share * static_cast<double>(close.size()));
    for (size_t i = 0; i < alone; ++i) {  // two other keyframes still see them, too few
      made.map.RemoveObservation(close[i], KeyframeId(3));
      made.map.RemoveObservation(close[i], KeyframeId(4));
    }
    Cull(made.map, KeyframeId(4), world.sensor());
    return !made.map.keyframes().Contains(KeyframeId(1));
  };
  EXPECT_TRUE(is_culled_with_share_alone(0.08));
  EXPECT_FALSE(is_culled_with_share_alone(0.12));
}

TEST(CullKeyframes, ObserversAtACoarserLevelDoNotCount) {
  const SyntheticWorld world;
  SyntheticMap made;
  std::vector<LandmarkId> landmarks(world.points().size());
  for (uint32_t i = 0; i < 5; ++i) {
    // All other keyframes are at the same place, but they see every patch at a level two higher
    // than keyframe 1 does.
    const SyntheticView view = world.Observe(FrameId(i), Rigid3());
    auto frame = std::make_shared<Frame>(*view.frame);
    for (Keypoint& keypoint : frame->features.keypoints) {
      keypoint.level = i == 1 ? 1 : 3;
    }
    const KeyframeId id = made.map.AddKeyframe(frame, Rigid3());
    for (uint32_t k = 0; k < view.points.size(); ++k) {
      LandmarkId& landmark = landmarks[view.points[k]];
      if (!landmark.IsValid()) {
        landmark = made.map.AddLandmark(world.points()[view.points[k]], id);
      }
      made.map.AddObservation(landmark, id, k);
    }
    UpdateCovisibility(made.map, id);
  }
  Cull(made.map, KeyframeId(4), world.sensor());
  EXPECT_TRUE(made.map.keyframes().Contains(KeyframeId(1)));
  EXPECT_FALSE(made.map.keyframes().Contains(KeyframeId(2)))
      << "keyframe 1 sees its landmarks at a finer level";
}

// Calls CullOverBound as mapping does, once for each of so many keyframes.
int CullOften(Map& map, const Sensor& sensor, size_t most, int times) {
  const KeyframeId current(map.keyframes().NextId().value - 1);
  int culled = 0;
  for (int i = 0; i < times; ++i) {
    culled += CullOverBound(map, current, sensor, kMinObjectViews, most);
    EXPECT_EQ(FindViolations(map), std::vector<std::string>());
  }
  return culled;
}

TEST(CullOverBound, KeepsAsManyAsItMayAndTheNewest) {
  const SyntheticWorld world;
  SyntheticMap made = NearbyKeyframes(world, 50);
  EXPECT_EQ(CullOften(made.map, world.sensor(), 50, 1), 0);
  EXPECT_EQ(CullOften(made.map, world.sensor(), 40, 1), 2) << "few at a time";
  EXPECT_EQ(CullOften(made.map, world.sensor(), 40, 9), 8);
  EXPECT_EQ(CullOften(made.map, world.sensor(), 1, 20), 18);
  EXPECT_TRUE(made.map.keyframes().Contains(KeyframeId(0))) << "the root";
  for (uint32_t i = 29; i < 50; ++i) {
    EXPECT_TRUE(made.map.keyframes().Contains(KeyframeId(i)));
  }
}

TEST(CullOverBound, AnObjectKeepsItsLastViews) {
  const SyntheticWorld world;
  SyntheticMap made = NearbyKeyframes(world, 50);
  const ObjectId object = made.map.AddObject();
  for (uint32_t i = 3; i <= 10; ++i) {
    ASSERT_TRUE(made.map.AddObservation(object, KeyframeId(i), 0));
  }
  CullOften(made.map, world.sensor(), 1, 20);
  EXPECT_EQ(made.map.keyframes().size(), 25u);
  EXPECT_EQ(made.map.objects().At(object).observations.size(), kMinObjectViews);
}

// Enough others see a quarter of what keyframe 1 sees, all of what keyframe 2 sees, and the less of
// what each of the next nine sees.
TEST(CullOverBound, TheMostRedundantGoFirstAndThoseThatSeeMostAloneStay) {
  Map map;
  std::vector<KeyframeId> ids;
  for (uint32_t i = 0; i < 40; ++i) {
    ids.push_back(map.AddKeyframe(MakeFrame(i, 300, 300), Rigid3()));
  }
  const std::vector<KeyframeId> place(ids.begin() + 2, ids.begin() + 12);
  Share(map, {ids[1], ids[0]}, 150);
  Share(map, {ids[1], ids[2], ids[3], ids[4], ids[5]}, 50);
  for (size_t i = 1; i < place.size(); ++i) {
    Share(map, {place[i], ids[0]}, 3 * static_cast<int>(i));
  }
  Share(map, place, 60);
  Share(map, {ids.begin() + 12, ids.end()}, 100);
  for (const KeyframeId id : ids) {
    UpdateCovisibility(map, id);
    if (id.value > 0 && !map.keyframes().At(id).parent.IsValid()) {
      SetParent(map, id, KeyframeId(0));
    }
  }
  CullOften(map, SyntheticSensor(), 38, 1);
  EXPECT_FALSE(map.keyframes().Contains(place[0]));
  EXPECT_TRUE(map.keyframes().Contains(place[9]));
  CullOften(map, SyntheticSensor(), 1, 30);
  EXPECT_TRUE(map.keyframes().Contains(ids[1]));
  EXPECT_LT(map.keyframes().size(), 34u);
}

TEST(FindRecentLandmarks, FindsLandmarksThatMayStillBeCulled) {
  Map map;
  for (int i = 0; i < 6; ++i) {
    AddKeyframe(map, 10);
  }
  std::vector<LandmarkId> made;
  for (uint32_t i = 0; i < 6; ++i) {
    made.push_back(map.AddLandmark({0.0, 0.0, 1.0}, KeyframeId(i)));
  }
  EXPECT_EQ(FindRecentLandmarks(map), (std::vector<LandmarkId>{made[3], made[4], made[5]}));
  EXPECT_TRUE(FindRecentLandmarks(Map()).empty());
}

constexpr size_t kKeypoints = 60;

class OldKeyframes : public testing::Test {
 protected:
  // A chain of keyframes, of which each shares 20 landmarks with the next one.
  void MakeChain(int count) {
    for (int i = 0; i < count; ++i) {
      ids_.push_back(AddKeyframe(map_, kKeypoints));
      if (i > 0) {
        Share(map_, {ids_[ids_.size() - 2], ids_.back()}, 20);
        UpdateCovisibility(map_, ids_.back());
      }
    }
    full_ = ids_;
  }
  bool IsFull(KeyframeId id) const {
    return map_.keyframes().At(id).frame->features.size() == kKeypoints;
  }

  Map map_;
  std::vector<KeyframeId> ids_;
  std::vector<KeyframeId> full_;
};

TEST_F(OldKeyframes, TwentyStayFull) {
  MakeChain(30);
  CompactOldKeyframes(map_, ids_.back(), full_);
  for (size_t i = 0; i < ids_.size(); ++i) {
    EXPECT_EQ(IsFull(ids_[i]), i >= 9) << i;
  }
  EXPECT_EQ(full_, std::vector<KeyframeId>(ids_.begin() + 9, ids_.end()));
  EXPECT_TRUE(FindViolations(map_).empty());
}

TEST_F(OldKeyframes, NeighboursOfNeighboursStayFull) {
  MakeChain(30);
  // The camera is back at the sixth keyframe.
  Share(map_, {ids_[5], ids_.back()}, 20);
  UpdateCovisibility(map_, ids_.back());
  CompactOldKeyframes(map_, ids_.back(), full_);
  for (size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(IsFull(ids_[i]), i >= 4 && i <= 6) << i;
  }
  EXPECT_TRUE(FindViolations(map_).empty());
}

TEST_F(OldKeyframes, CulledOnesAreForgotten) {
  MakeChain(6);
  map_.CullKeyframe(ids_[2]);
  CompactOldKeyframes(map_, ids_.back(), full_);
  EXPECT_EQ(full_, (std::vector<KeyframeId>{ids_[0], ids_[1], ids_[3], ids_[4], ids_[5]}));
}

}  // namespace
}  // namespace hullslam
