// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/arrangement.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "objects/made_room.h"

namespace hullslam {
namespace {

class ArrangementTest : public ::testing::Test {
 protected:
  ArrangementTest() { AddRoom(map_, sensor_, room_); }
  Arrangement Compare(const Frame& frame, const Rigid3& pose) const {
    return CompareArrangement(map_, ObjectIndex(map_, sensor_.camera), sensor_, frame, pose,
                              IslandId(0), {});
  }
  Sensor sensor_ = MakeObjectSensor();
  const std::vector<MadeObject> room_ = MakeRoom();
  Map map_;
  const Rigid3 pose_ = CameraOnCircle(0.5, 2.0, 0.8);
};

TEST_F(ArrangementTest, FromTheTruePoseEveryDetectionShowsItsObject) {
  const Arrangement found = Compare(SeeRoom(sensor_, room_, pose_), pose_);
  ASSERT_EQ(found.objects.size(), room_.size());
  for (uint32_t i = 0; i < room_.size(); ++i) {
    EXPECT_EQ(found.objects[i], ObjectId(i));
  }
  EXPECT_EQ(found.matched, 7);
  EXPECT_EQ(found.missed, 0);
  EXPECT_GT(found.overlap, 6.8);
  EXPECT_EQ(found.Score(), found.overlap);
}

TEST_F(ArrangementTest, TheScoreFallsWithTheErrorOfThePose) {
  const Frame frame = SeeRoom(sensor_, room_, pose_);
  double last = Compare(frame, pose_).Score();
  for (const double angle : {0.51, 0.53, 0.56}) {
    const double score = Compare(frame, CameraOnCircle(angle, 2.0, 0.8)).Score();
    EXPECT_LT(score, last) << angle;
    last = score;
  }
}

TEST_F(ArrangementTest, AnObjectThatIsNotDetectedCountsAgainstIt) {
  std::vector<MadeObject> less = room_;
  less.erase(less.begin() + 4);  // the ball, which nothing hides
  const Arrangement found = Compare(SeeRoom(sensor_, less, pose_), pose_);
  EXPECT_EQ(found.matched, 6);
  EXPECT_EQ(found.missed, 1);
  EXPECT_EQ(found.Score(), found.overlap - 0.5);
}

TEST_F(ArrangementTest, AHiddenObjectDoesNotCountAgainstIt) {
  Frame frame = SeeRoom(sensor_, {room_[0]}, pose_);
  frame.depth = DepthGrid(cv::Mat(480, 640, CV_16UC1, cv::Scalar(500)), 1000.0);
  const Arrangement found = Compare(frame, pose_);
  EXPECT_EQ(found.matched, 1);
  EXPECT_EQ(found.missed, 0);
}

TEST_F(ArrangementTest, ClassesMustAgree) {
  std::vector<MadeObject> others = room_;
  others[0].label = "chair";
  const Arrangement found = Compare(SeeRoom(sensor_, others, pose_), pose_);
  EXPECT_FALSE(found.objects[0].IsValid());
  EXPECT_EQ(found.matched, 6);
}

TEST_F(ArrangementTest, OnlyMappedObjectsAreCompared) {
  map_.MutableObject(ObjectId(0)).state = ObjectState::kCandidate;
  const Arrangement found = Compare(SeeRoom(sensor_, room_, pose_), pose_);
  EXPECT_FALSE(found.objects[0].IsValid());
  EXPECT_EQ(found.matched, 6);
  EXPECT_EQ(Compare(SeeRoom(sensor_, {}, pose_), pose_).missed, 6);
}

// A box on the left of the ball's projected ellipse that has this share of its width.
TEST_F(ArrangementTest, ADetectionMustOverlapByThreeTenths) {
  const auto matched = [&](double share) {
    Frame frame = SeeRoom(sensor_, {room_[4]}, pose_);
    Detection& ball = frame.detections.at(0);
    ball.is_box = true;
    ball.box.max().x() = ball.box.min().x() + share * ball.box.sizes().x();
    return Compare(frame, pose_).matched;
  };
  EXPECT_EQ(matched(0.33), 1);
  EXPECT_EQ(matched(0.27), 0);
}

}  // namespace
}  // namespace hullslam
