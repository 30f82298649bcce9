// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/frame_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "features/find_near.h"
#include "hullslam/util/error.h"
#include "support/expect_error.h"
#include "support/fisheye_camera.h"
#include "support/made_vocabulary.h"
#include "support/square_mask.h"
#include "support/test_cameras.h"

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

// An image of bright and dark rectangles, and depths of a slanted surface that differ from pixel to
// pixel and have holes.
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
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      image.depth.at<uint16_t>(y, x) = static_cast<uint16_t>(6000 + 11 * x + 7 * y);
    }
  }
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

// The left image keeps corners on straight edges, because they have a depth; so must the right one.
TEST_F(FrameBuilderTest, BothImagesOfAPairKeepCornersOnStraightEdges) {
  const ImageInput pair = MakePair();
  const auto known = [&](bool keep_edges) {
    FeatureOptions options = FewFeatures();
    options.keep_edges = keep_edges;
    const auto frame =
        FrameBuilder(StereoSensor(), DepthOptions(), options).Build(pair, runner_).frame;
    return std::ranges::count_if(frame->features.depth, [](float depth) { return depth > 0.0F; });
  };
  EXPECT_EQ(known(false), known(true));
}

TEST_F(FrameBuilderTest, PairsThatAreNoneAreRefused) {
  ImageInput pair = MakePair();
  const Sensor stereo = StereoSensor();
  FrameBuilder builder(stereo, DepthOptions(), FewFeatures());
  EXPECT_NO_THROW(builder.Build(pair, runner_));
  pair.right = pair.grey;
  FrameBuilder other(stereo, DepthOptions(), FewFeatures());
  ExpectInputError([&] { other.Build(pair, runner_); }, {"the same image"});
  pair = MakePair();
  std::swap(pair.grey, pair.right);
  FrameBuilder swapped(stereo, DepthOptions(), FewFeatures());
  ExpectInputError([&] { swapped.Build(pair, runner_); }, {"swapped"});
}

TEST_F(FrameBuilderTest, DepthInAnotherUnitIsNoticed) {
  ImageInput image = MakeImage();
  DepthOptions depth;
  depth.units_per_metre = 100.0;
  FrameBuilder builder(sensor_, depth, FewFeatures());
  builder.Build(image, runner_);
  ASSERT_EQ(builder.warnings().size(), 1U);
  EXPECT_NE(builder.warnings()[0].find("DepthMapFactor 100"), std::string::npos);
  image.depth.convertTo(image.depth, CV_32FC1);
  ExpectInputError([&] { Build(image); }, {"float32", "expected metres"});
}

TEST_F(FrameBuilderTest, MasksOfTheRightImageAddLines) {
  ImageInput pair = MakePair();
  pair.masks = {Square("cup", 30, 160, 50), Square("book", 200, 60, 80)};
  pair.right_masks = {Square("book", 200 - kDisparity, 60, 80), Square("dog", 30, 40, 50),
                      Square("person", 250, 160, 60)};
  const Sensor stereo = StereoSensor();
  FrameBuilder builder(stereo, DepthOptions(), FewFeatures(), DetectionOptions(), {"person"});
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
  const std::vector<WordId> expected = vocabulary->WordsOf(frame->features.descriptors);
  EXPECT_EQ(frame->words.get(), expected);
  const auto later = builder.Build(MakeImage(), runner_, false, false).frame;
  EXPECT_FALSE(later->words.is_absent());
  EXPECT_EQ(later->words.get(), expected);
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
    unknown += units == 0 ? 1 : 0;
  }
  EXPECT_GT(unknown, 0);
  EXPECT_LT(unknown, static_cast<int>(features.size()));
}

TEST_F(FrameBuilderTest, TheGridFindsEveryKeypointAtItsRawPixel) {
  const auto frame = Build(MakeImage());
  const FrameFeatures& features = frame->features;
  for (uint32_t i = 0; i < features.size(); ++i) {
    const Keypoint& keypoint = features.keypoints[i];
    std::vector<uint32_t> found;
    const Eigen::Vector2d raw = sensor_.camera.Distort(keypoint.undistorted.cast<double>());
    FindNear(features.grid, features.keypoints, raw.cast<float>(), 0.5f, keypoint.level,
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

// A textured thing over two thirds of the image must not use up the wanted number of keypoints.
TEST_F(FrameBuilderTest, KeypointsAreChosenBesideDynamicThings) {
  const ImageInput image = MakeImage();
  FeatureOptions few = FewFeatures();
  few.feature_count = 60;
  const auto build = [&](std::vector<InstanceMask> masks) {
    ImageInput input = image;
    input.masks = std::move(masks);
    return FrameBuilder(sensor_, DepthOptions(), few, DetectionOptions(), {"person"})
        .Build(input, runner_)
        .frame;
  };
  InstanceMask person = Square("person", 0, 0, 240);
  for (Eigen::Vector2d& corner : person.outlines.front()) {
    corner.x() *= 200.0 / 240.0;
  }
  const size_t wanted = build({})->features.size();
  const auto frame = build({person});
  EXPECT_GT(frame->features.size(), wanted * 8 / 10);
  EXPECT_TRUE(KeypointsInside(*frame, 0.0, 0.0, 200.0).empty());
}

// The mask of the right image does for the right keypoints what that of the left image does.
TEST_F(FrameBuilderTest, KeypointsOfTheRightImageAreChosenBesideDynamicThings) {
  ImageInput pair = MakePair();
  FeatureOptions few = FewFeatures();
  few.feature_count = 16;
  const auto count_with_depth = [&] {
    const auto frame =
        FrameBuilder(StereoSensor(), DepthOptions(), few, DetectionOptions(), {"person"})
            .Build(pair, runner_)
            .frame;
    return std::ranges::count_if(frame->features.depth, [](float depth) { return depth > 0.0F; });
  };
  const auto person = [](double right) {
    InstanceMask mask = Square("person", 0, 0, 240);
    for (Eigen::Vector2d& corner : mask.outlines.front()) {
      corner.x() *= right / 240.0;
    }
    return mask;
  };
  pair.masks = {person(200.0)};
  const auto of_left = count_with_depth();
  pair.right_masks = {person(200.0 - kDisparity)};
  EXPECT_GT(count_with_depth(), of_left + 2);
}

TEST_F(FrameBuilderTest, OneMaskForAllImagesHidesItsPixels) {
  ImageInput image = MakeImage();
  image.masks = {Square("book", 200, 60, 80)};
  Sensor sensor = sensor_;
  sensor.mask_all = cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(1));
  const auto all = FrameBuilder(sensor, DepthOptions(), FewFeatures()).Build(image, runner_).frame;
  EXPECT_EQ(all->features.descriptors, Build(image)->features.descriptors) << "all pixels are used";
  sensor.mask_all.colRange(kWidth / 2, kWidth).setTo(0);
  const auto half = FrameBuilder(sensor, DepthOptions(), FewFeatures()).Build(image, runner_).frame;
  EXPECT_GT(half->features.size(), 100u);
  for (const Keypoint& keypoint : half->features.keypoints) {
    EXPECT_LT(std::lround(RawPixel(keypoint).x()), kWidth / 2);
  }
  EXPECT_EQ(all->detections.size(), 1u);
  EXPECT_TRUE(half->detections.empty()) << "nothing of the book is used";
}

// Beyond 80 degrees from the axis nothing is used, and the keypoints are chosen inside.
TEST_F(FrameBuilderTest, TheBorderOfAFisheyeImageUsesUpNoKeypoints) {
  Sensor sensor;
  sensor.kind = SensorKind::kMonocular;
  sensor.camera = FisheyeCamera();
  sensor.camera.width = kWidth;
  sensor.camera.height = kHeight;
  sensor.camera.fx = sensor.camera.fy = 60.0;  // 80 degrees are 84 px
  sensor.camera.cx = 160.0;
  sensor.camera.cy = 120.0;
  sensor.bounds = sensor.camera.UndistortedBounds();
  sensor.levels = ScaleLevels::Create(4, 1.2);
  FeatureOptions few = FewFeatures();
  few.feature_count = 60;
  ImageInput image = MakeImage();
  image.depth = cv::Mat();
  const auto frame = FrameBuilder(sensor, DepthOptions(), few).Build(image, runner_).frame;
  EXPECT_GE(frame->features.size(), 50u);
  for (const Keypoint& keypoint : frame->features.keypoints) {
    const Eigen::Vector2d raw = sensor.camera.Distort(keypoint.undistorted.cast<double>());
    EXPECT_LT((raw - Eigen::Vector2d(160.0, 120.0)).norm(), 86.0);
  }
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
  }
}

// A slanted plane with a random texture, seen without noise. The depth image has a depth for the
// centre of each pixel of the grey one.
class SlantedPlane : public testing::TestWithParam<TestCamera> {
 protected:
  // The depth (z, m) of the plane along the ray to an undistorted pixel of a camera at `centre`,
  // which is turned as the world is.
  double DepthAt(const Eigen::Vector2d& undistorted, const Eigen::Vector3d& centre) const {
    const Eigen::Vector3d ray = sensor_.camera.Unproject(undistorted, 1.0);
    return (kDistance - kNormal.dot(centre)) / kNormal.dot(ray);
  }

  std::unique_ptr<const Frame> See(const Eigen::Vector3d& centre) {
    const PinholeCamera& camera = sensor_.camera;
    ImageInput image;
    image.grey = cv::Mat(camera.height, camera.width, CV_8UC1, cv::Scalar(0));
    image.depth = cv::Mat(camera.height, camera.width, CV_16UC1, cv::Scalar(0));
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        const Eigen::Vector2d raw(x, y);
        const Eigen::Vector2d pixel = camera.Undistort(raw);
        const double z = DepthAt(pixel, centre);
        if (camera.SeesRaw(raw) && z > 0.0 && z < 6.0) {
          image.grey.at<uint8_t>(y, x) = Texture(centre + camera.Unproject(pixel, z));
          image.depth.at<uint16_t>(y, x) = static_cast<uint16_t>(std::lround(5000.0 * z));
        }
      }
    }
    return FrameBuilder(sensor_, DepthOptions(), {.feature_count = 1500})
        .Build(image, runner_)
        .frame;
  }

  const Sensor sensor_ = GetParam().sensor;

 private:
  // Squares of 3, 8 and 20 cm, so that there are corners at all levels.
  static uint8_t Texture(const Eigen::Vector3d& point) {
    uint32_t sum = 0;
    for (const double side : {0.03, 0.08, 0.20}) {
      uint32_t hash = 17;
      for (const double along : {point.x(), point.y()}) {
        const auto cell = static_cast<int32_t>(std::floor(along / side));
        hash = (hash ^ static_cast<uint32_t>(cell)) * 0x9E3779B1U;
        hash ^= hash >> 15;
      }
      sum += hash % 80;
    }
    return static_cast<uint8_t>(10 + sum);
  }

  static constexpr double kDistance = 1.6;  // m
  const Eigen::Vector3d kNormal = Eigen::Vector3d(0.25, -0.35, 1.0).normalized();
  SerialRunner runner_;
};

// Stereo pairs have no depth image.
INSTANTIATE_TEST_SUITE_P(Cameras, SlantedPlane,
                         testing::Values(TestCameras()[0], TestCameras()[1], TestCameras()[2]),
                         NameOfCamera);

// The depth is that of the nearest pixel, so single ones differ by the slant on half a pixel. In
// the mean of each level there is no difference: grey image and depth have the same pixel centres.
TEST_P(SlantedPlane, DepthAndGreyImageHaveTheSamePixels) {
  const std::unique_ptr<const Frame> frame = See(Eigen::Vector3d::Zero());
  std::map<int, std::vector<double>> errors;  // relative, of the inverse depth, by level
  for (size_t i = 0; i < frame->features.size(); ++i) {
    const Keypoint& keypoint = frame->features.keypoints[i];
    const double found = static_cast<double>(frame->features.depth[i]);
    if (found > 0.0) {
      const double truth = DepthAt(keypoint.undistorted.cast<double>(), Eigen::Vector3d::Zero());
      errors[keypoint.level].push_back(truth / found - 1.0);
      EXPECT_NEAR(truth / found, 1.0, 0.02);
    }
  }
  ASSERT_EQ(errors.size(), 8u);
  for (const auto& [level, of_level] : errors) {
    const double count = static_cast<double>(of_level.size());
    const double sum = std::accumulate(of_level.begin(), of_level.end(), 0.0);
    EXPECT_GT(count, 30.0) << level;
    EXPECT_NEAR(sum / count, 0.0, 2e-4) << level;
  }
}

// The displacement of keypoints between two views is that which their depth tells.
TEST_P(SlantedPlane, DepthAgreesWithTheParallaxOfTwoViews) {
  const Eigen::Vector3d other(0.2, 0.05, 0.0);
  const std::unique_ptr<const Frame> a = See(Eigen::Vector3d::Zero());
  const std::unique_ptr<const Frame> b = See(other);
  const FrameFeatures& seen = a->features;
  double product = 0.0;  // of the error along the parallax and the parallax, px^2
  double square = 0.0;   // of the parallax
  int count = 0;
  for (size_t i = 0; i < seen.size(); ++i) {
    const double z = static_cast<double>(seen.depth[i]);
    if (z <= 0.0) {
      continue;
    }
    const Eigen::Vector3d point =
        sensor_.camera.Unproject(seen.keypoints[i].undistorted.cast<double>(), z);
    const Eigen::Vector2d expected = sensor_.camera.Distort(sensor_.camera.Project(point - other));
    const Eigen::Vector2d far =
        sensor_.camera.Distort(seen.keypoints[i].undistorted.cast<double>());
    std::vector<uint32_t> near;
    FindNear(b->features.grid, b->features.keypoints, expected.cast<float>(), 3.0F,
             seen.keypoints[i].level, seen.keypoints[i].level, near);
    if (near.size() == 1 &&
        HammingDistance(seen.descriptors[i], b->features.descriptors[near[0]]) <= 40) {
      const Eigen::Vector2d found =
          sensor_.camera.Distort(b->features.keypoints[near[0]].undistorted.cast<double>());
      const Eigen::Vector2d parallax = expected - far;
      product += (found - expected).dot(parallax);
      square += parallax.squaredNorm();
      ++count;
    }
  }
  ASSERT_GT(count, 250);
  EXPECT_NEAR(product / square, 0.0, 0.004);
}

}  // namespace
}  // namespace hullslam
