// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/input_check.h"

#include <gtest/gtest.h>

#include <vector>

#include "features/test_images.h"
#include "support/expect_error.h"
#include "support/turned_right.h"

namespace hullslam {
namespace {

// The image moved by a number of pixels to the left and down.
cv::Mat Move(const cv::Mat& image, int left, int down) {
  cv::Mat moved(image.size(), CV_8UC1, cv::Scalar(120));
  const cv::Rect from(left, 0, image.cols - left, image.rows - down);
  image(from).copyTo(moved(cv::Rect(0, down, from.width, from.height)));
  return moved;
}

std::string FaultOf(const cv::Mat& left, const cv::Mat& right) {
  PairCheck check;
  check.Add(left, right);
  return check.FindFault().value_or("");
}

TEST(PairCheck, AGoodPairHasNoFault) {
  const cv::Mat image = MakeCornerImage();
  EXPECT_EQ(FaultOf(image, Move(image, 20, 0)), "");
  EXPECT_EQ(FaultOf(image, Move(image, 20, 1)), "");
}

TEST(PairCheck, FaultsAreNamed) {
  const cv::Mat image = MakeCornerImage();
  EXPECT_NE(FaultOf(Move(image, 20, 0), image).find("swapped"), std::string::npos);
  EXPECT_NE(FaultOf(image, image).find("the same image"), std::string::npos);
  EXPECT_NE(FaultOf(image, Move(image, 20, 6)).find("6.0 px lower"), std::string::npos);
}

TEST(PairCheck, RowsThatAreNotNeededAreNoFault) {
  const cv::Mat image = MakeCornerImage();
  PairCheck check;
  check.Add(image, Move(image, 20, 6));
  EXPECT_TRUE(check.FindFault().has_value());
  EXPECT_FALSE(check.FindFault(false).has_value());
}

// A rotation about the optical axis leaves the median of the rows as it is.
TEST(PairCheck, RowsThatAreALittleWrongAreDoubted) {
  const cv::Mat image = MakeCornerImage();
  const auto doubt_of = [&](const cv::Mat& right) {
    PairCheck check;
    check.Add(image, right);
    EXPECT_FALSE(check.FindFault().has_value());
    return check.FindDoubt().value_or("");
  };
  const cv::Mat moved = Move(image, 20, 0);
  EXPECT_EQ(doubt_of(moved), "");
  EXPECT_NE(doubt_of(Move(image, 20, 1)).find("wrong by 1.0 px"), std::string::npos);
  const PinholeCamera camera{.fx = 500.0, .fy = 500.0, .cx = 320.0, .cy = 240.0};
  EXPECT_NE(doubt_of(TurnedRight(moved, camera, {0.0, 0.0, 0.01})).find("`hullslam calibrate`"),
            std::string::npos);
}

TEST(PairCheck, FewMatchesSayNothing) {
  const cv::Mat grey(480, 640, CV_8UC1, cv::Scalar(90));
  EXPECT_EQ(FaultOf(grey, grey), "");
}

class InputCheckTest : public ::testing::Test {
 protected:
  // The image moved to the left and down.
  static cv::Mat Move(const cv::Mat& image, int left, int down) {
    cv::Mat moved(image.size(), CV_8UC1, cv::Scalar(120));
    const cv::Rect from(left, 0, image.cols - left, image.rows - down);
    image(from).copyTo(moved(cv::Rect(0, down, from.width, from.height)));
    return moved;
  }

  static DepthOptions WithUnits(double per_metre) {
    DepthOptions options;
    options.units_per_metre = per_metre;
    return options;
  }

  static Sensor Rgbd() {
    Sensor sensor;
    sensor.camera = {.fx = 500, .fy = 500, .cx = 320, .cy = 240, .width = 640, .height = 480};
    return sensor;
  }

  static Sensor Stereo(double baseline) {
    Sensor sensor = Rgbd();
    sensor.kind = SensorKind::kStereo;
    sensor.camera.bf = baseline * sensor.camera.fx;
    return sensor;
  }

  // Gives pairs that are moved down by these rows. All their points have this depth.
  static void Add(const std::vector<int>& rows, double depth, InputCheck& check) {
    FeatureExtractor extractor{FeatureOptions()};
    const cv::Mat image = MakeCornerImage();
    const ExtractedFeatures left = extractor.Extract(image);
    const std::vector<float> depths(left.keypoints.size(), static_cast<float>(depth));
    for (const int row : rows) {
      check.CheckPair(left, extractor.Extract(Move(image, 20, row)), depths);
    }
  }
};

TEST_F(InputCheckTest, PlausibleDepthIsNoFault) {
  const Sensor sensor = Rgbd();
  InputCheck check(sensor, WithUnits(5000.0));
  check.CheckDepth(cv::Mat(48, 64, CV_16UC1, cv::Scalar(10000)));
  EXPECT_TRUE(check.warnings().empty());
  InputCheck metres(sensor, {});
  metres.CheckDepth(cv::Mat(48, 64, CV_32FC1, cv::Scalar(2.0)));
  EXPECT_TRUE(metres.warnings().empty());
}

TEST_F(InputCheckTest, OnlyTheFirstDepthThatIsKnownCounts) {
  const Sensor sensor = Rgbd();
  InputCheck check(sensor, WithUnits(1000.0));
  check.CheckDepth(cv::Mat(48, 64, CV_16UC1, cv::Scalar(0)));
  for (int i = 0; i < 3; ++i) {
    check.CheckDepth(cv::Mat(48, 64, CV_16UC1, cv::Scalar(10000)));
  }
  ASSERT_EQ(check.warnings().size(), 1U);
  EXPECT_NE(check.warnings()[0].find("is 10 m with DepthMapFactor 1000"), std::string::npos)
      << check.warnings()[0];
}

TEST_F(InputCheckTest, DepthInMetresThatCannotBeMetresIsRefused) {
  const Sensor sensor = Rgbd();
  InputCheck check(sensor, {});
  cv::Mat raw(48, 64, CV_32FC1, cv::Scalar(9000.0));
  ExpectInputError([&] { check.CheckDepth(raw); }, {"float32", "9000", "expected metres"});
  raw.rowRange(0, 8).setTo(3.0);  // of a scene with a sky
  check.CheckDepth(raw);
  EXPECT_EQ(check.warnings().size(), 1U);
}

TEST_F(InputCheckTest, PairsInEqualRowsAreNoFault) {
  const Sensor sensor = Stereo(0.12);
  InputCheck check(sensor, {});
  Add(std::vector<int>(40, 0), 3.0, check);
  EXPECT_TRUE(check.warnings().empty());
}

TEST_F(InputCheckTest, RigsOfCarsAreNoFault) {
  for (const double baseline : {0.06, 0.54, 2.0}) {
    const Sensor sensor = Stereo(baseline);
    InputCheck check(sensor, {});
    Add({0, 0, 0}, 30.0, check);
    EXPECT_TRUE(check.warnings().empty()) << check.warnings()[0];
  }
}

TEST_F(InputCheckTest, PairsThatAreNoneAreRefused) {
  const Sensor sensor = Stereo(0.12);
  InputCheck check(sensor, {});
  FeatureExtractor extractor{FeatureOptions()};
  const ExtractedFeatures features = extractor.Extract(MakeCornerImage());
  const std::vector<float> depths(features.keypoints.size());
  for (int i = 0; i < 5; ++i) {
    ExpectInputError([&] { check.CheckPair(features, features, depths); }, {"the same image"});
  }
}

TEST_F(InputCheckTest, RowsThatDisagreeNowAndThenAreThoseOfALateImage) {
  const Sensor sensor = Stereo(0.12);
  InputCheck check(sensor, {});
  Add(std::vector<int>(3, 0), 3.0, check);
  Add(std::vector<int>(40, 6), 3.0, check);
  ASSERT_EQ(check.warnings().size(), 1U);
  EXPECT_NE(check.warnings()[0].find("taken at the same time"), std::string::npos);
}

TEST_F(InputCheckTest, APrincipalPointAtTheBorderIsNamed) {
  Sensor sensor = Stereo(0.1);
  sensor.camera.cx = 400;
  EXPECT_TRUE(InputCheck(sensor, {}).warnings().empty());
  sensor.camera.width = 320;  // the images are half as large as those of the calibration
  sensor.camera.height = 240;
  EXPECT_NE(InputCheck(sensor, {}).warnings().at(0).find("(400, 240) is far from the middle"),
            std::string::npos);
}

TEST_F(InputCheckTest, BaselinesAndDepthsThatNoCameraHasAreNamed) {
  const Sensor tiny = Stereo(0.0002);
  EXPECT_NE(InputCheck(tiny, {}).warnings().at(0).find("the baseline is 0.0002 m"),
            std::string::npos);
  const Sensor sensor = Stereo(2.9);
  InputCheck check(sensor, {});
  Add({0, 0, 0}, 2000.0, check);
  ASSERT_EQ(check.warnings().size(), 1U);
  EXPECT_NE(check.warnings()[0].find("2e+03 m, with a baseline of 2.9 m"), std::string::npos)
      << check.warnings()[0];
}

}  // namespace

}  // namespace hullslam
