// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/contradicted_object.h"

#include <gtest/gtest.h>

#include <memory>
#include <opencv2/core/mat.hpp>
#include <utility>

#include "objects/made_objects.h"

namespace hullslam {
namespace {

// A cup that a camera at the world's origin sees 1 m ahead, in five keyframes.
class ContradictedObject : public ::testing::Test {
 protected:
  ContradictedObject() {
    cup_.world_from_object.translation = {0.0, 0.0, 1.0};
    cup_.half_axes = {0.05, 0.05, 0.06};
    id_ = map_.AddObject();
    map_.MutableObject(id_).ellipsoid = cup_;
    for (int i = 0; i < 5; ++i) {
      Find();
    }
  }
  void Join(KeyframeId id) {
    if (id != KeyframeId(0)) {
      map_.MutableKeyframe(id).covisible = map_.keyframes().At(KeyframeId(id.value - 1)).covisible;
      map_.MutableKeyframe(id).covisible.push_back({KeyframeId(id.value - 1), 20});
    }
    current_ = id;
  }
  void Find() {
    const KeyframeId id = AddObserver(map_, sensor_, Rigid3(), {{"cup", cup_}});
    map_.AddObservation(id_, id, 0);
    Join(id);
  }
  bool IsGoneAfter(int millimetres) {
    return IsGoneAfter(millimetres, FrameId(map_.keyframes().NextId().value));
  }
  // The keyframe is made of this frame, and observes the object if `is_found`.
  bool IsGoneAfter(int millimetres, FrameId id, bool is_found = false) {
    auto frame = std::make_shared<Frame>();
    frame->id = id;
    if (is_found) {
      frame->detections = {Detect({"cup", cup_}, sensor_, Rigid3())};
    }
    frame->depth = DepthGrid(cv::Mat(480, 640, CV_16UC1, cv::Scalar(millimetres)), 1000.0);
    Join(map_.AddKeyframe(std::move(frame), Rigid3()));
    if (is_found) {
      map_.AddObservation(id_, current_, 0);
    }
    return IsContradicted(map_, sensor_, current_, id_, options_, contradictions_);
  }

  const Sensor sensor_ = MakeObjectSensor();
  const ChangeOptions options_;
  Map map_;
  Contradictions<ObjectId> contradictions_;
  Ellipsoid cup_;
  ObjectId id_;
  KeyframeId current_;
};

TEST_F(ContradictedObject, IsGoneAfterThreeKeyframesThatSeeThroughIt) {
  EXPECT_FALSE(IsGoneAfter(2000));
  EXPECT_FALSE(IsGoneAfter(2000));
  EXPECT_TRUE(IsGoneAfter(2000));
}

TEST_F(ContradictedObject, IsThereWhereDepthDoesNotShowWhatIsBehindIt) {
  for (const int millimetres : {500, 0, 1000, 950}) {
    for (int i = 0; i < 5; ++i) {
      EXPECT_FALSE(IsGoneAfter(millimetres)) << millimetres << " mm";
    }
  }
}

TEST_F(ContradictedObject, IsThereAgainOnceItIsObserved) {
  IsGoneAfter(2000);
  IsGoneAfter(2000);
  Find();
  EXPECT_FALSE(IsGoneAfter(2000));
  EXPECT_FALSE(IsGoneAfter(2000));
  EXPECT_FALSE(IsGoneAfter(500)) << "the newest keyframe does not contradict it";
  EXPECT_TRUE(IsGoneAfter(2000));
}

// A mask says more than depth: that of glass is the depth behind it. So a keyframe that observes
// the object does not contradict it, and the count begins again after it.
TEST_F(ContradictedObject, IsThereWhereItIsObserved) {
  EXPECT_FALSE(IsGoneAfter(2000, FrameId(10)));
  EXPECT_FALSE(IsGoneAfter(2000, FrameId(11)));
  EXPECT_FALSE(IsGoneAfter(2000, FrameId(12), true));
  EXPECT_FALSE(IsGoneAfter(2000, FrameId(13)));
  EXPECT_FALSE(IsGoneAfter(2000, FrameId(14)));
  EXPECT_TRUE(IsGoneAfter(2000, FrameId(15)));
}

// Late masks make a keyframe of a frame that was taken before the last observation.
TEST_F(ContradictedObject, AFrameBeforeTheLastObservationSaysNothing) {
  EXPECT_FALSE(IsGoneAfter(1000, FrameId(100), true));
  for (const uint32_t frame : {50U, 60U, 70U, 80U}) {
    EXPECT_FALSE(IsGoneAfter(2000, FrameId(frame)));
  }
  EXPECT_FALSE(IsGoneAfter(2000, FrameId(101)));
  EXPECT_FALSE(IsGoneAfter(2000, FrameId(102)));
  EXPECT_TRUE(IsGoneAfter(2000, FrameId(103)));
}

}  // namespace
}  // namespace hullslam
