// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/stereo_pairing.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

constexpr double kRate = 20.0;  // images per second

class StereoPairing : public ::testing::Test {
 protected:
  // Stamps that begin at `begin` and are `step` apart.
  static std::vector<double> Stamps(size_t count, double begin = 100.0, double step = 1.0 / kRate) {
    std::vector<double> stamps;
    for (size_t i = 0; i < count; ++i) {
      stamps.push_back(begin + step * static_cast<double>(i));
    }
    return stamps;
  }
  std::vector<IndexPair> Pair(const std::vector<double>& left, const std::vector<double>& right) {
    return PairStereoStamps("a.bag", {"/left", left}, {"/right", right}, kRate, warnings_);
  }

  std::vector<std::string> warnings_;
};

TEST_F(StereoPairing, ASmallDelayChangesNothing) {
  const std::vector<IndexPair> pairs = Pair(Stamps(30), Stamps(30, 100.002));
  ASSERT_EQ(pairs.size(), 30u);
  EXPECT_EQ(pairs[7], (IndexPair{7, 7}));
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(StereoPairing, ImagesWithoutAPartnerAreCountedAndSaid) {
  std::vector<double> right = Stamps(31, 99.95);  // one more at the begin
  right.erase(right.begin() + 4);                 // the partner of 3
  const std::vector<IndexPair> pairs = Pair(Stamps(30), right);
  ASSERT_EQ(pairs.size(), 29u);
  EXPECT_EQ(pairs[2], (IndexPair{2, 3}));
  EXPECT_EQ(pairs[3], (IndexPair{4, 4}));
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_EQ(warnings_[0],
            "a.bag: 1 of 30 images of /left and 1 of 30 of /right have no partner within 2.5 ms "
            "and are left out");
}

TEST_F(StereoPairing, CamerasThatAreNotSynchronisedAreRefused) {
  ExpectInputError([&] { Pair(Stamps(30), Stamps(30, 100.02)); },
                   {"a.bag: 0 of 30 images of /left have one of /right within 2.5 ms",
                    "smallest gap is 20.0 ms", "synchronised"});
  ExpectInputError([&] { Pair(Stamps(30), {}); }, {"0 of 30"});
}

// Each pair is near enough, so nothing but the drift tells.
TEST_F(StereoPairing, StampsThatDriftApartAreRefused) {
  ExpectInputError([&] { Pair(Stamps(100), Stamps(100, 99.998, 0.05004)); },
                   {"a.bag: the stamps of /left and /right drift apart",
                    "-1.8 ms later at the begin", "1.8 ms later at the end"});
  EXPECT_EQ(Pair(Stamps(100), Stamps(100, 99.998, 0.05002)).size(), 100u);
}

TEST(StereoLoading, PairsAreRectifiedWithTheirMasks) {
  StereoCalibration calibration;
  calibration.left = {.fx = 60.0, .fy = 60.0, .cx = 40.0, .cy = 30.0, .width = 80, .height = 60};
  calibration.right = calibration.left;
  calibration.right.cy = 34.0;  // points lie 4 px lower in the right image
  calibration.right_from_left.translation = {-0.1, 0.0, 0.0};
  const auto rectifier = std::make_shared<const StereoRectifier>(calibration, "test");
  const TemporaryFolder folder;
  cv::Mat left(60, 80, CV_8UC1, cv::Scalar(0));
  cv::Mat right = left.clone();
  left.row(20) = cv::Scalar(200);
  right.row(24) = cv::Scalar(200);
  FramePaths frame{1.0, folder.path() / "left.png"};
  frame.right = folder.path() / "right.png";
  cv::imwrite(frame.image.string(), left);
  cv::imwrite(frame.right.string(), right);
  ImageSequence sequence;
  LoadWithoutDepth(sequence);
  RectifyPairs(rectifier, sequence);
  const ImageInput pair = sequence.load(frame, rectifier->camera());
  EXPECT_EQ(pair.timestamp, 1.0);
  EXPECT_GT(cv::norm(pair.grey), 0.0);
  EXPECT_LT(cv::norm(pair.grey, pair.right, cv::NORM_INF), 3.0) << "the lines are in equal rows";
  EXPECT_EQ(sequence.load_colour(frame).type(), CV_8UC3);
  const Eigen::Quaterniond& q = rectifier->rectified_from_left().rotation;
  std::istringstream rotation(sequence.choices.at("rectified_from_left"));
  for (const double expected : {q.x(), q.y(), q.z(), q.w()}) {
    double number = 0.0;
    rotation >> number;
    EXPECT_NEAR(number, expected, 1e-9);
  }
  const Trajectory read = AsRead(sequence, {{1.0, Rigid3()}});
  EXPECT_EQ(read[0].world_from_cam.rotation.coeffs(), q.coeffs()) << "of the camera as read";
  sequence.converted_groundtruth = read;
  EXPECT_LT(ReadGroundtruth(sequence)->front().world_from_cam.rotation.angularDistance(
                Eigen::Quaterniond::Identity()),
            1e-9)
      << "of the rectified camera";
  std::vector<InstanceMask> masks(1);
  masks[0].outlines = {{{40.0, 20.0}, {50.0, 20.0}, {50.0, 25.0}}};
  FitMasks(sequence.warps, ImageSide::kLeft, masks);
  const double row = masks[0].outlines[0][0].y();
  EXPECT_GT(pair.grey.at<uint8_t>(static_cast<int>(std::lround(row)), 40), 100)
      << "the mask follows the line";
  masks[0].outlines = {{{40.0, 24.0}, {50.0, 24.0}, {50.0, 29.0}}};
  FitMasks(sequence.warps, ImageSide::kRight, masks);
  EXPECT_NEAR(masks[0].outlines[0][0].y(), row, 1e-6);
  PinholeCamera other = rectifier->camera();
  other.width = 40;
  ExpectInputError([&] { sequence.load(frame, other); }, {"left.png", "80x60", "40x60"});
}

// TUM-VI has images of 16 bits.
TEST(StereoLoading, RectifiedPairsNeedNothing) {
  ImageSequence sequence;
  LoadWithoutDepth(sequence);
  RectifyPairs(nullptr, sequence);
  const TemporaryFolder folder;
  const cv::Mat image(60, 80, CV_16UC1, cv::Scalar(0x12F0));
  FramePaths frame{1.0, folder.path() / "left.png"};
  frame.right = frame.image;
  cv::imwrite(frame.image.string(), image);
  const PinholeCamera camera{.fx = 60.0, .fy = 60.0, .width = 80, .height = 60};
  EXPECT_EQ(sequence.load(frame, camera).right.at<uint8_t>(30, 40), 0x12);
  EXPECT_EQ(sequence.load_colour(frame).at<cv::Vec3b>(30, 40), cv::Vec3b(0x12, 0x12, 0x12));
  EXPECT_TRUE(sequence.warps.empty());
  EXPECT_TRUE(sequence.choices.empty());
}

}  // namespace

}  // namespace hullslam
