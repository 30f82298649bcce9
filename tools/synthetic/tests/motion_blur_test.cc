// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/motion_blur.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "synthetic/object_models.h"
#include "synthetic/scenes.h"
#include "synthetic/sequence_writer.h"
#include "synthetic/tests/image_motion.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;

// Dark on the left and bright from column 80 on, 2 m away.
RenderedFrame EdgeFrame() {
  const PinholeCamera camera = SmallCamera();
  const cv::Size size(camera.width, camera.height);
  RenderedFrame frame{.colour = cv::Mat(size, CV_32FC3, cv::Scalar(20.0, 20.0, 20.0)),
                      .depth = cv::Mat(size, CV_32FC1, cv::Scalar(2.0)),
                      .instance = cv::Mat(size, CV_16SC1, cv::Scalar(-1)),
                      .cosine = cv::Mat(size, CV_32FC1, cv::Scalar(1.0))};
  frame.colour.colRange(80, camera.width) = cv::Scalar(220.0, 120.0, 20.0);
  return frame;
}

Scene SceneWithCameraSpeed(const Vector3d& metres_per_second) {
  Scene scene;
  scene.world_from_cam = [metres_per_second](double time) {
    return Rigid3{Eigen::Quaterniond::Identity(), time * metres_per_second};
  };
  return scene;
}

double Difference(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF); }

TEST(BlurByMotion, WithoutExposureOrMotionNothingChanges) {
  const RenderedFrame frame = EdgeFrame();
  const Scene moving = SceneWithCameraSpeed({1.0, 0.0, 0.0});
  EXPECT_EQ(Difference(BlurByMotion(frame, moving, SmallCamera(), {.time = 1.0}), frame.colour), 0);
  const Scene still = SceneWithCameraSpeed(Vector3d::Zero());
  const cv::Mat blurred = BlurByMotion(frame, still, SmallCamera(), {.duration = 0.02});
  EXPECT_EQ(Difference(blurred, frame.colour), 0.0);
}

// At 2 m and 3 m/s, the surface moves by 133.85 * 3 * 0.05 / 2 = 10 px in 0.05 s.
TEST(BlurByMotion, AnEdgeBecomesARampAsLongAsTheMotion) {
  const RenderedFrame frame = EdgeFrame();
  const Scene scene = SceneWithCameraSpeed({3.0, 0.0, 0.0});
  for (const double readout : {0.0, 0.03}) {
    const cv::Mat blurred = BlurByMotion(frame, scene, SmallCamera(),
                                         {.time = 1.0, .readout_time = readout, .duration = 0.05});
    for (const int y : {0, 60, 119}) {
      for (int x = 60; x < 100; ++x) {
        const double share = std::clamp((x - 79.5 + 5.02) / 10.04, 0.0, 1.0);
        EXPECT_NEAR(blurred.at<cv::Vec3f>(y, x)[0], 20.0 + 200.0 * share, 14.0) << x;
        EXPECT_FLOAT_EQ(blurred.at<cv::Vec3f>(y, x)[2], 20.0F);
      }
    }
  }
}

TEST(BlurByMotion, OnlyTheObjectThatMovesIsBlurredBeforeAStillCamera) {
  RenderedFrame frame = EdgeFrame();
  frame.instance.rowRange(0, 60) = 0;
  Scene scene = SceneWithCameraSpeed(Vector3d::Zero());
  scene.objects.push_back(MakeSolid("vase", Shape::Box({1.0, 1.0, 1.0}), {}).Build({}, 0.0));
  scene.objects.back().motion = [](double time) { return Shift(2.0 * time, 0.0, 2.0); };
  const cv::Mat blurred =
      BlurByMotion(frame, scene, SmallCamera(), {.time = 1.0, .duration = 0.05});
  EXPECT_NEAR(blurred.at<cv::Vec3f>(30, 80)[0], 130.0, 30.0);
  EXPECT_EQ(Difference(blurred.rowRange(60, 120), frame.colour.rowRange(60, 120)), 0.0);
}

// The mean of many images at moments of the exposure is the true blurred image.
TEST(BlurByMotion, IsNearTheMeanOfManyImages) {
  const Scene scene = BuildScene(SceneKind::kDesk, 300, 1);
  const PinholeCamera camera = SyntheticCamera();
  const Renderer renderer(scene, camera);
  const Exposure exposure{.time = 2.0, .duration = 0.1};
  const RenderedFrame frame = renderer.Render(exposure.time);
  constexpr int kImages = 12;
  cv::Mat mean(frame.colour.size(), CV_32FC3, cv::Scalar(0.0, 0.0, 0.0));
  for (int i = 0; i < kImages; ++i) {
    const double share = (i + 0.5) / kImages - 0.5;
    mean += renderer.Render(exposure.time + share * exposure.duration).colour / kImages;
  }
  const cv::Mat blurred = BlurByMotion(frame, scene, camera, exposure);
  EXPECT_LT(cv::norm(blurred, mean, cv::NORM_L1), 0.4 * cv::norm(frame.colour, mean, cv::NORM_L1));
}

}  // namespace
}  // namespace hullslam::synthetic
