// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/frame_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/util/error.h"
#include "support/expect_error.h"
#include "support/made_vocabulary.h"
#include "support/square_mask.h"

namespace hullslam {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

// The camera of TUM freiburg1, which has strong distortion, at half its size.
Sensor DistortedSensor() {
  Sensor sensor;
  sensor.camera = {.fx = 258.653204,
                   .fy = 258.234607,
                   .cx = 159.321520,
                   .cy = 127.656994,
                   .k1 = 0.262383,
                   .k2 = -0.953104,
                   .p1 = -0.005358,
                   .p2 = 0.002628,
                   .k3 = 1.163314,
                   .width = kWidth,
                   .height = kHeight,
                   .bf = 20.0};
  sensor.bounds = sensor.camera.UndistortedBounds();
  sensor.levels = ScaleLevels::Create(4, 1.2);
  return sensor;
}

FeatureOptions FewFeatures() {
  FeatureOptions options;
  options.feature_count = 300;
  options.level_count = 4;
  options.keep_edges = true;
  return options;
}

// An image of bright and dark rectangles, and depths that change from pixel to pixel and have
// holes.
ImageInput MakeImage() {
  ImageInput image;
  image.timestamp = 12.5;
  image.grey = cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(90));
  cv::RNG random(7);
  for (int i = 0; i < 120; ++i) {
    const cv::Rect box(random.uniform(0, kWidth - 24), random.uniform(0, kHeight - 24),
                       random.uniform(6, 24), random.uniform(6, 24));
    image.grey(box).setTo(random.uniform(0, 256));
  }
  image.depth = cv::Mat(kHeight, kWidth, CV_16UC1);
  random.fill(image.depth, cv::RNG::UNIFORM, 5000, 20000);
  image.depth(cv::Rect(0, 0, kWidth / 2, kHeight / 2)).setTo(0);
  return image;
}

Sensor StereoSensor() {
  Sensor stereo = DistortedSensor();
  stereo.kind = SensorKind::kStereo;
  stereo.camera = {.fx = 260.0,
                   .fy = 260.0,
                   .cx = 159.5,
                   .cy = 119.5,
                   .width = kWidth,
                   .height = kHeight,
                   .bf = 30.0};
  return stereo;
}

constexpr int kDisparity = 15;  // px, of a plane at 2 m

// The pair of images of that plane.
ImageInput MakePair() {
  ImageInput pair = MakeImage();
  pair.depth.release();
  pair.right = cv::Mat(pair.grey.size(), CV_8UC1, cv::Scalar(90));
  pair.grey.colRange(kDisparity, kWidth).copyTo(pair.right.colRange(0, kWidth - kDisparity));
  return pair;
}

Eigen::Vector2d RawPixel(const Keypoint& keypoint) {
  return DistortedSensor().camera.Distort(keypoint.undistorted.cast<double>());
}

// The indices of the keypoints whose raw pixel is in a square.
std::vector<uint32_t> KeypointsInside(const Frame& frame, double left, double top, double side) {
  const Eigen::AlignedBox2d square(Eigen::Vector2d(left, top),
                                   Eigen::Vector2d(left + side, top + side));
  std::vector<uint32_t> inside;
  for (uint32_t i = 0; i < frame.features.size(); ++i) {
    if (square.contains(RawPixel(frame.features.keypoints[i]).array().round().matrix())) {
      inside.push_back(i);
    }
  }
  return inside;
}

class FrameBuilderTest : public testing::Test {
 protected:
  std::unique_ptr<const Frame> Build(const ImageInput& image) {
    return FrameBuilder(sensor_, DepthOptions(), FewFeatures()).Build(image, runner_).frame;
  }

  SerialRunner runner_;
  const Sensor sensor_ = DistortedSensor();
};

TEST_F(FrameBuilderTest, HasOneEntryPerKeypointAndItsStamp) {
  const auto frame = Build(MakeImage());
  EXPECT_EQ(frame->timestamp, 12.5);
  const FrameFeatures& features = frame->features;
  ASSERT_GT(features.size(), 100u);
  EXPECT_EQ(features.descriptors.size(), features.size());
  EXPECT_EQ(features.depth.size(), features.size());
  EXPECT_EQ(features.right_u.size(), features.size());
}

TEST_F(FrameBuilderTest, LeavesOutFeaturesOnStraightEdgesOnlyWithoutDepth) {
  ImageInput image;
  image.grey = cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(60));
  image.grey.colRange(kWidth / 2, kWidth).setTo(200);
  for (int y = 2; y < kHeight; y += 12) {
    image.grey.at<uint8_t>(y, kWidth / 2 - 3) = 85;  // a corner, but only the edge is strong
  }
  Sensor monocular = sensor_;
  monocular.kind = SensorKind::kMonocular;
  FeatureOptions options = FewFeatures();
  options.feature_count = 16;
  options.level_count = 1;
  const auto count = [&](const Sensor& sensor) {
    FrameBuilder builder(sensor, DepthOptions(), options);
    return builder.Build(image, runner_).frame->features.size();
  };
  const size_t kept = count(monocular);
  EXPECT_GE(kept, 10u);
  options.keep_edges = false;
  EXPECT_LE(count(monocular), 10u) << "half of the wanted number, and up to two more";
  image.depth = cv::Mat(kHeight, kWidth, CV_16UC1, cv::Scalar(10000));
  EXPECT_EQ(count(sensor_), kept);
}

TEST_F(FrameBuilderTest, MasksOfTheRightImageAddLines) {
  ImageInput pair = MakePair();
  pair.masks = {Square("cup", 30, 160, 50), Square("book", 200, 60, 80)};
  pair.right_masks = {Square("book", 200 - kDisparity, 60, 80), Square("dog", 30, 40, 50),
                      Square("person", 250, 160, 60)};
  FrameBuilder builder(StereoSensor(), DepthOptions(), FewFeatures(), DetectionOptions(),
                       {"person"});
  const BuiltFrame built = builder.Build(pair, runner_);
  ASSERT_EQ(built.frame->detections.size(), 2u);
  EXPECT_TRUE(built.frame->detections[0].right_lines.empty());
  const Detection& book = built.frame->detections[1];
  ASSERT_EQ(book.right_lines.size(), book.lines.size());
  for (size_t i = 0; i < book.lines.size(); ++i) {
    const Line2& left = book.lines[i].line;
    EXPECT_NEAR(book.right_lines[i].line.offset, left.offset + kDisparity * left.normal.x(), 1e-6);
  }
  EXPECT_EQ(built.masks.right_masks, 1u);
  EXPECT_EQ(built.masks.rejections.at(DetectionRejection::kNotInLeft), 1u) << "the dog";
  ImageInput without_right = MakeImage();
  without_right.right_masks = pair.right_masks;
  ExpectInputError([&] { Build(without_right); }, {"masks of a right image"});
}

// A whole pixel of an upper level is several pixels of the image.
TEST_F(FrameBuilderTest, PositionsAreFinerThanAPixelAsAreDisparities) {
  const Sensor stereo = StereoSensor();
  const ImageInput pair = MakePair();
  FeatureOptions options = FewFeatures();
  options.level_count = 1;
  const auto frame = FrameBuilder(stereo, DepthOptions(), options).Build(pair, runner_).frame;
  size_t between = 0;
  size_t at_two = 0;
  size_t known = 0;
  for (size_t i = 0; i < frame->features.size(); ++i) {
    const float x = frame->features.keypoints[i].undistorted.x();
    between += std::abs(x - std::round(x)) > 0.05F ? 1 : 0;
    known += frame->features.depth[i] > 0.0F ? 1 : 0;
    at_two += std::abs(frame->features.depth[i] - 2.0F) < 0.02F ? 1 : 0;
  }
  EXPECT_GT(between, frame->features.size() / 2);
  EXPECT_GT(known, frame->features.size() / 4);
  EXPECT_GT(at_two, known * 9 / 10);
}

TEST_F(FrameBuilderTest, HasOneWordPerKeypointWithAVocabulary) {
  EXPECT_TRUE(Build(MakeImage())->words.empty());
  const auto vocabulary = SharedVocabulary();
  FrameBuilder builder(sensor_, DepthOptions(), FewFeatures(), std::nullopt, {}, vocabulary);
  const auto frame = builder.Build(MakeImage(), runner_).frame;
  ASSERT_GT(frame->features.size(), 100u);
  EXPECT_EQ(frame->words, vocabulary->WordsOf(frame->features.descriptors));
}

TEST_F(FrameBuilderTest, KeypointsAreUndistorted) {
  const ImageInput image = MakeImage();
  const auto frame = Build(image);
  const std::vector<RawKeypoint> extracted =
      FeatureExtractor(FewFeatures()).Extract(image.grey).keypoints;
  ASSERT_EQ(frame->features.size(), extracted.size());
  float farthest = 0.0f;
  for (size_t i = 0; i < extracted.size(); ++i) {
    const Keypoint& keypoint = frame->features.keypoints[i];
    EXPECT_LT((RawPixel(keypoint) - extracted[i].raw.cast<double>()).norm(), 1e-3);
    EXPECT_EQ(keypoint.angle, extracted[i].angle);
    EXPECT_EQ(keypoint.level, extracted[i].level);
    farthest = std::max(farthest, (keypoint.undistorted - extracted[i].raw).norm());
  }
  EXPECT_GT(farthest, 1.0f) << "the camera distorts by more than a pixel";
}

TEST_F(FrameBuilderTest, DepthIsThatOfTheRawPixel) {
  const ImageInput image = MakeImage();
  const auto frame = Build(image);
  const FrameFeatures& features = frame->features;
  const std::vector<RawKeypoint> extracted =
      FeatureExtractor(FewFeatures()).Extract(image.grey).keypoints;
  ASSERT_EQ(features.size(), extracted.size());
  int unknown = 0;
  for (size_t i = 0; i < features.size(); ++i) {
    const Eigen::Vector2f raw = extracted[i].raw;
    const auto units = image.depth.at<uint16_t>(static_cast<int>(std::round(raw.y())),
                                                static_cast<int>(std::round(raw.x())));
    EXPECT_FLOAT_EQ(features.depth[i], static_cast<float>(units) / 5000.0f);
    if (units == 0) {
      ++unknown;
      EXPECT_EQ(features.right_u[i], -1.0f);
    } else {
      EXPECT_NEAR(features.right_u[i], features.keypoints[i].undistorted.x() - 100000.0f / units,
                  1e-3f);
    }
  }
  EXPECT_GT(unknown, 0);
  EXPECT_LT(unknown, static_cast<int>(features.size()));
}

TEST_F(FrameBuilderTest, TheGridFindsEveryKeypointWhereItIsUndistorted) {
  const auto frame = Build(MakeImage());
  const FrameFeatures& features = frame->features;
  for (uint32_t i = 0; i < features.size(); ++i) {
    const Keypoint& keypoint = features.keypoints[i];
    std::vector<uint32_t> found;
    features.grid.FindNear(features.keypoints, keypoint.undistorted, 0.5f, keypoint.level,
                           keypoint.level, found);
    EXPECT_NE(std::find(found.begin(), found.end(), i), found.end()) << i;
  }
}

TEST_F(FrameBuilderTest, MetresInFloatGiveTheSameDepth) {
  ImageInput image = MakeImage();
  const auto units = Build(image);
  image.depth.convertTo(image.depth, CV_32FC1, 1.0 / 5000.0);
  const auto metres = Build(image);
  ASSERT_EQ(units->features.size(), metres->features.size());
  for (size_t i = 0; i < units->features.size(); ++i) {
    EXPECT_FLOAT_EQ(units->features.depth[i], metres->features.depth[i]);
  }
}

TEST_F(FrameBuilderTest, AnImageWithoutCornersGivesAFrameWithoutKeypoints) {
  ImageInput image = MakeImage();
  image.grey.setTo(128);
  EXPECT_EQ(Build(image)->features.size(), 0u);
}

TEST_F(FrameBuilderTest, MasksGiveDetectionsInUndistortedPixels) {
  ImageInput image = MakeImage();
  image.masks = {Square("cup", 20, 160, 50), Square("book", 200, 60, 80)};
  const auto frame = Build(image);
  ASSERT_EQ(frame->detections.size(), 2u);
  const Detection& book = frame->detections[1];
  EXPECT_EQ(frame->detections[0].label, "cup");
  EXPECT_EQ(book.label, "book");
  const Eigen::Vector2d corner = sensor_.camera.Undistort({280.0, 140.0});
  EXPECT_GT((corner - Eigen::Vector2d(280.0, 140.0)).norm(), 0.5);
  EXPECT_LT(book.box.exteriorDistance(corner), 0.1);
  EXPECT_EQ(book.keypoints, KeypointsInside(*frame, 200.0, 60.0, 80.0));
  EXPECT_FALSE(book.keypoints.empty());
}

TEST_F(FrameBuilderTest, MasksOfStaticThingsLeaveTheKeypointsAsTheyAre) {
  ImageInput image = MakeImage();
  const auto without = Build(image);
  EXPECT_TRUE(without->detections.empty());
  image.masks = {Square("cup", 20, 160, 50)};
  const auto with = Build(image);
  EXPECT_EQ(with->features.descriptors, without->features.descriptors);
}

TEST_F(FrameBuilderTest, DynamicThingsHideTheirKeypointsAndAreNoDetections) {
  ImageInput image = MakeImage();
  const auto all = Build(image);
  ASSERT_FALSE(KeypointsInside(*all, 200.0, 60.0, 80.0).empty());
  image.masks = {Square("person", 200, 60, 80), Square("cup", 20, 160, 50)};
  const auto frame =
      FrameBuilder(sensor_, DepthOptions(), FewFeatures(), DetectionOptions(), {"person"})
          .Build(image, runner_)
          .frame;
  EXPECT_TRUE(KeypointsInside(*frame, 200.0, 60.0, 80.0).empty());
  EXPECT_GT(frame->features.size(), all->features.size() / 2);
  EXPECT_EQ(frame->features.descriptors.size(), frame->features.size());
  EXPECT_EQ(frame->features.depth.size(), frame->features.size());
  ASSERT_EQ(frame->detections.size(), 1u);
  EXPECT_EQ(frame->detections[0].label, "cup");
}

TEST_F(FrameBuilderTest, DynamicThingsMayKeepTheirKeypoints) {
  ImageInput image = MakeImage();
  const auto all = Build(image);
  image.masks = {Square("person", 200, 60, 80), Square("cup", 20, 160, 50)};
  const auto frame = FrameBuilder(sensor_, DepthOptions(), FewFeatures(), DetectionOptions(),
                                  {"person"}, nullptr, false)
                         .Build(image, runner_)
                         .frame;
  EXPECT_EQ(frame->features.descriptors, all->features.descriptors);
  ASSERT_EQ(frame->detections.size(), 1u) << "they are no objects either";
}

TEST_F(FrameBuilderTest, WithoutObjectsThereAreNoDetectionsButDynamicThingsStillHide) {
  ImageInput image = MakeImage();
  image.masks = {Square("person", 200, 60, 80), Square("cup", 20, 160, 50)};
  FrameBuilder builder(sensor_, DepthOptions(), FewFeatures(), std::nullopt, {"person"});
  const BuiltFrame built = builder.Build(image, runner_);
  EXPECT_TRUE(built.frame->detections.empty());
  EXPECT_TRUE(KeypointsInside(*built.frame, 200.0, 60.0, 80.0).empty());
  EXPECT_EQ(built.masks.detections, 0u);
  EXPECT_EQ(built.masks.frames_with_masks, 1u);
}

TEST_F(FrameBuilderTest, FramesKeepAGridOfTheirDepthWithAndWithoutObjects) {
  const ImageInput image = MakeImage();
  const DepthGrid expected(image.depth, 5000.0);
  for (const auto& detection :
       {std::optional(DetectionOptions()), std::optional<DetectionOptions>()}) {
    FrameBuilder builder(sensor_, DepthOptions(), FewFeatures(), detection);
    EXPECT_EQ(builder.Build(image, runner_).frame->depth.samples(), expected.samples());
  }
}

TEST_F(FrameBuilderTest, CountsAreOfTheFrame) {
  FrameBuilder builder(sensor_, DepthOptions(), FewFeatures(), DetectionOptions(), {"person"});
  ImageInput image = MakeImage();
  EXPECT_EQ(builder.Build(image, runner_).masks.frames_with_masks, 0u);
  image.masks = {Square("cup", 20, 160, 50), Square("mouse", 100, 100, 4)};
  for (int i = 0; i < 2; ++i) {
    const BuiltFrame built = builder.Build(image, runner_);
    EXPECT_EQ(built.masks.frames_with_masks, 1u);
    EXPECT_EQ(built.masks.detections, 1u);
    EXPECT_EQ(built.masks.rejections,
              (std::map<DetectionRejection, size_t>{{DetectionRejection::kTooSmall, 1u}}));
    image.masks.push_back(Square("person", 200, 60, 80));
  }
}

// Runs the tasks from the last to the first, as a second thread might.
class BackwardRunner final : public TaskRunner {
 public:
  void Run(size_t count, const std::function<void(size_t)>& task) override {
    for (size_t i = count; i > 0; --i) {
      task(i - 1);
    }
  }
};

TEST_F(FrameBuilderTest, TheOrderOfTheTasksDoesNotMatter) {
  ImageInput image = MakeImage();
  image.masks = {Square("cup", 20, 160, 50), Square("mouse", 100, 100, 4),
                 Square("book", 22, 158, 50), Square("bowl", 180, 40, 60)};
  FrameBuilder builder(sensor_, DepthOptions(), FewFeatures());
  const BuiltFrame forward = builder.Build(image, runner_);
  BackwardRunner backward_runner;
  const BuiltFrame backward = builder.Build(image, backward_runner);
  const Frame& expected = *forward.frame;
  const Frame& frame = *backward.frame;
  ASSERT_EQ(frame.features.descriptors, expected.features.descriptors);
  EXPECT_EQ(frame.features.depth, expected.features.depth);
  for (size_t i = 0; i < frame.features.size(); ++i) {
    EXPECT_EQ(frame.features.keypoints[i].undistorted, expected.features.keypoints[i].undistorted);
    EXPECT_EQ(frame.features.keypoints[i].level, expected.features.keypoints[i].level);
  }
  EXPECT_EQ(backward.masks.rejections, forward.masks.rejections);
  ASSERT_EQ(frame.detections.size(), 2u);
  ASSERT_EQ(expected.detections.size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(frame.detections[i].label, expected.detections[i].label);
    EXPECT_EQ(frame.detections[i].points, expected.detections[i].points);
    EXPECT_EQ(frame.detections[i].lines.size(), expected.detections[i].lines.size());
  }
}

TEST_F(FrameBuilderTest, ImagesOfAnotherSizeAreRefused) {
  ImageInput image = MakeImage();
  image.grey = image.grey(cv::Rect(0, 0, kWidth - 1, kHeight));
  ExpectInputError([&] { Build(image); }, {"319x240", "320x240"});
  image = MakeImage();
  image.depth = image.depth(cv::Rect(0, 0, kWidth, kHeight - 4));
  ExpectInputError([&] { Build(image); }, {"depth", "320x236", "expected the shape", "320x240"});
  image.depth = cv::Mat();
  EXPECT_THROW(Build(image), InputError);
}

TEST_F(FrameBuilderTest, DepthOfAnotherSizeIsFitted) {
  ImageInput image = MakeImage();
  image.depth = cv::Mat(kHeight / 4, kWidth / 4, CV_16UC1, cv::Scalar(10000));
  const auto frame = Build(image);
  ASSERT_GT(frame->features.size(), 100u);
  EXPECT_EQ(std::ranges::count(frame->features.depth, 2.0F),
            static_cast<std::ptrdiff_t>(frame->features.size()));
  EXPECT_EQ(frame->depth.columns(), DepthGrid::CountAlong(kWidth));
}

TEST_F(FrameBuilderTest, ImagesOfAnotherTypeAreRefusedWhateverTheyShow) {
  ImageInput image = MakeImage();
  image.grey.convertTo(image.grey, CV_16UC1);
  EXPECT_THROW(Build(image), InputError);
  image = MakeImage();
  image.grey.setTo(128);  // without keypoints no depth is looked up
  image.depth.convertTo(image.depth, CV_8UC1);
  EXPECT_THROW(Build(image), InputError);
}

TEST_F(FrameBuilderTest, AMonocularCameraHasNoDepth) {
  Sensor sensor = sensor_;
  sensor.kind = SensorKind::kMonocular;
  FrameBuilder builder(sensor, DepthOptions(), FewFeatures());
  ImageInput image = MakeImage();
  ExpectInputError([&] { builder.Build(image, runner_); }, {"depth image", "none"});
  image.depth = cv::Mat();
  const auto frame = builder.Build(image, runner_).frame;
  ASSERT_EQ(frame->features.size(), Build(MakeImage())->features.size());
  for (size_t i = 0; i < frame->features.size(); ++i) {
    EXPECT_EQ(frame->features.depth[i], 0.0f);
    EXPECT_EQ(frame->features.right_u[i], -1.0f);
  }
}

}  // namespace
}  // namespace hullslam
