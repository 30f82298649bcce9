// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/pose_source.h"

#include <gtest/gtest.h>

#include <utility>

#include "support/synthetic_world.h"

namespace hullslam {
namespace {

// The camera was at the pose of keyframe 0 and moved on by `motion` in the time of one frame.
class MotionModel : public testing::Test {
 protected:
  LastFrame LastFrameAtKeyframe(const Rigid3& motion) const {
    const Keyframe& keyframe = made_.map.keyframes().At(KeyframeId(0));
    LastFrame last;
    last.frame = keyframe.frame;
    last.landmarks = keyframe.landmarks;
    last.reference = KeyframeId(0);
    last.cam_from_world = keyframe.cam_from_world;
    last.motion = CameraMotion{motion, 1.0 / world_.sensor().frames_per_second};
    return last;
  }
  // The pose of the frame that is seen from `truth`, if the camera is expected to make `motion`.
  std::optional<PoseEstimate> Estimate(const Rigid3& motion, const Rigid3& truth,
                                       int max_level = 7) const {
    SyntheticView view = world_.Observe(FrameId(100), truth);
    auto frame = std::make_shared<Frame>(*view.frame);
    for (size_t i = 0; i < frame->features.size(); ++i) {
      if (frame->features.keypoints[i].level > max_level) {
        frame->features.descriptors[i] = {};  // not to be recognised
      }
    }
    LastFrame last = LastFrameAtKeyframe(motion);
    frame->timestamp = last.frame->timestamp + last.motion->duration;
    return PoseByMotionModel(*frame, made_.map, {world_.sensor(), options_, objects_, index_},
                             last);
  }
  static Rigid3 Forward(double metres) {
    return {Eigen::Quaterniond::Identity(), {0.0, 0.0, -metres}};
  }

  const SyntheticWorld world_;
  SyntheticMap made_ = MakeSyntheticMap(world_, {0, 5});
  TrackingOptions options_;
  ObjectOptions objects_;
  const ObjectIndex index_{};
};

// Patches grow and shrink by several levels of the pyramid when the camera moves by metres.
TEST_F(MotionModel, FindsPatchesThatChangedTheirSize) {
  const Rigid3 start = made_.map.keyframes().At(KeyframeId(0)).cam_from_world;
  const auto still = Estimate(Rigid3(), start);
  ASSERT_TRUE(still);
  EXPECT_GT(still->inliers, 200);
  const auto back = Estimate(Forward(-3.0), Forward(-3.0) * start);
  ASSERT_TRUE(back);
  EXPECT_GT(back->inliers, still->inliers * 9 / 10);  // all are still in the image
  const auto forward = Estimate(Forward(1.0), Forward(1.0) * start);
  ASSERT_TRUE(forward);
  EXPECT_GT(forward->inliers, still->inliers / 4);  // many have left the image
}

// 25 px are more than the window at the finest levels, but less than the wider one.
TEST_F(MotionModel, SearchesAWiderWindowIfTooLittleIsFound) {
  const Rigid3 start = made_.map.keyframes().At(KeyframeId(0)).cam_from_world;
  const double turn = 25.0 / world_.sensor().camera.fx;
  const Rigid3 truth = Rigid3(ExpSo3({0.0, turn, 0.0}), Eigen::Vector3d::Zero()) * start;
  const auto wide = Estimate(Rigid3(), truth, 1);
  ASSERT_TRUE(wide);
  EXPECT_LT(AngularDistance(wide->cam_from_world.rotation, truth.rotation), 1e-3);
  const Rigid3 far = Rigid3(ExpSo3({0.0, 2.0 * turn, 0.0}), Eigen::Vector3d::Zero()) * start;
  EXPECT_FALSE(Estimate(Rigid3(), far, 1));
}

}  // namespace
}  // namespace hullslam
