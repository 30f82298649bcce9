// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/reduced_frame.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "frame/rolling_shutter.h"

namespace hullslam {
namespace {

Frame MakeFullFrame() {
  Frame frame;
  frame.id = FrameId(7);
  frame.timestamp = 1.5;
  FrameFeatures& features = frame.features;
  for (uint32_t i = 0; i < 10; ++i) {
    Keypoint& keypoint = features.keypoints.emplace_back();
    keypoint.undistorted = {40.0f * static_cast<float>(i) + 5.0f, 100.0f};
    keypoint.level = static_cast<int>(i % 3);
    features.descriptors.push_back({i, 2 * i, 3 * i, 4 * i});
    features.depth.push_back(static_cast<float>(i));
  }
  features.grid = FeatureGrid(features.keypoints, {0.0f, 0.0f}, {640.0f, 480.0f});
  frame.detections.resize(3);
  frame.detections[0].label = "cup";
  frame.detections[1].label = "book";
  frame.detections[1].keypoints = {0, 2, 3, 9};
  frame.detections[2].label = "ball";
  frame.detections[2].keypoints = {1, 4};
  frame.depth = DepthGrid(cv::Mat(480, 640, CV_16UC1, cv::Scalar(1000)), 1000.0);
  return frame;
}

TEST(ReducedFrame, HasTheChosenKeypointsAndDetections) {
  const Frame frame = MakeFullFrame();
  const std::vector<uint32_t> keypoints = {2, 4, 9};
  const std::vector<uint32_t> detections = {1, 2};
  const auto reduced = ReduceFrame(frame, keypoints, detections);
  EXPECT_EQ(reduced->id, frame.id);
  EXPECT_EQ(reduced->timestamp, frame.timestamp);
  ASSERT_EQ(reduced->features.size(), 3u);
  for (size_t i = 0; i < keypoints.size(); ++i) {
    const size_t former = keypoints[i];
    EXPECT_EQ(reduced->features.keypoints[i].undistorted,
              frame.features.keypoints[former].undistorted);
    EXPECT_EQ(reduced->features.keypoints[i].level, frame.features.keypoints[former].level);
    EXPECT_EQ(reduced->features.descriptors[i], frame.features.descriptors[former]);
    EXPECT_EQ(reduced->features.depth[i], frame.features.depth[former]);
  }
  ASSERT_EQ(reduced->detections.size(), 2u);
  EXPECT_EQ(reduced->detections[0].label, "book");
  EXPECT_EQ(reduced->detections[0].keypoints, (std::vector<uint32_t>{0, 2}));
  EXPECT_EQ(reduced->detections[1].label, "ball");
  EXPECT_EQ(reduced->detections[1].keypoints, (std::vector<uint32_t>{1}));
  EXPECT_TRUE(reduced->depth.empty());
}

TEST(ReducedFrame, FindsItsKeypointsUnderTheirNewIndices) {
  const Frame frame = MakeFullFrame();
  const auto reduced = ReduceFrame(frame, std::vector<uint32_t>{2, 4, 9}, {});
  for (uint32_t i = 0; i < 3; ++i) {
    std::vector<uint32_t> found;
    reduced->features.grid.FindNear(reduced->features.keypoints,
                                    reduced->features.keypoints[i].undistorted, 1.0f, 0, 7, found);
    EXPECT_EQ(found, std::vector<uint32_t>{i});
  }
  EXPECT_TRUE(reduced->detections.empty());
}

TEST(ReducedFrame, KeepsHowTheShutterOfItsKeypointsWasCorrected) {
  Frame frame;
  frame.features.keypoints.resize(3);
  frame.features.descriptors.resize(3);
  frame.features.depth.resize(3);
  frame.features.grid = FeatureGrid(frame.features.keypoints, {0.0f, 0.0f}, {640.0f, 480.0f});
  auto shutter = std::make_shared<ShutterMotion>();
  shutter->velocity.linear = {1.0, 2.0, 3.0};
  shutter->inverse_depths = {0.1, 0.2, 0.3};
  frame.shutter = shutter;
  const std::vector<uint32_t> kept = {0, 2};
  const auto reduced = ReduceFrame(frame, kept, {});
  ASSERT_NE(reduced->shutter, nullptr);
  EXPECT_EQ(reduced->shutter->velocity.linear, shutter->velocity.linear);
  EXPECT_EQ(reduced->shutter->inverse_depths, (std::vector<double>{0.1, 0.3}));
}

TEST(ReducedFrame, CanHaveNoKeypoints) {
  const auto reduced = ReduceFrame(MakeFullFrame(), {}, {});
  EXPECT_EQ(reduced->features.size(), 0u);
  std::vector<uint32_t> found;
  reduced->features.grid.FindNear({}, {100.0f, 100.0f}, 500.0f, 0, 7, found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace hullslam
