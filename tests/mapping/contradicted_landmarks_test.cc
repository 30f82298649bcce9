// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/contradicted_landmarks.h"

#include <gtest/gtest.h>

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <utility>

#include "map/covisibility.h"
#include "map/invariants.h"
#include "map/landmark_edits.h"
#include "map/made_map.h"
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

}  // namespace
}  // namespace hullslam
