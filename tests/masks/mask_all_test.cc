// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/mask_all.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <string>

#include "images/image_file.h"
#include "sequences/resized_images.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

class MaskAll : public testing::Test {
 protected:
  std::filesystem::path Write(const cv::Mat& image, const std::string& name = "mask.png") const {
    return folder_.Write(name, EncodeImage(image, name.substr(name.rfind('.'))));
  }

  const TemporaryFolder folder_;
  const PinholeCamera camera_ = {.width = 64, .height = 48};
  ImageSequence sequence_;
};

TEST_F(MaskAll, IgnoresBlackPixelsOnly) {
  cv::Mat grey(48, 64, CV_8UC1, cv::Scalar(0));
  grey.at<unsigned char>(2, 3) = 255;
  grey.at<unsigned char>(2, 4) = 1;
  const cv::Mat mask = ReadMaskAll(Write(grey), sequence_, camera_);
  ASSERT_EQ(mask.type(), CV_8UC1);
  EXPECT_EQ(cv::countNonZero(mask != (grey > 0)), 0);
  EXPECT_EQ(cv::countNonZero(mask == 255), 2);
  EXPECT_NEAR(IgnoredShare(mask), 1.0 - 2.0 / (48 * 64), 1e-12);
  EXPECT_EQ(IgnoredShare(cv::Mat()), 0.0);
  cv::Mat colour(48, 64, CV_8UC3, cv::Scalar(0, 0, 0));
  colour.at<cv::Vec3b>(5, 6) = {1, 0, 0};  // a blue so dark that its luma is 0
  const cv::Mat of_colour = ReadMaskAll(Write(colour), sequence_, camera_);
  EXPECT_EQ(cv::countNonZero(of_colour), 1);
  EXPECT_EQ(of_colour.at<unsigned char>(5, 6), 255);
}

TEST_F(MaskAll, HasTheSizeOfTheImagesAsRead) {
  const cv::Mat grey(24, 32, CV_8UC1, cv::Scalar(255));
  const auto path = Write(grey);
  ExpectInputError([&] { ReadMaskAll(path, sequence_, camera_); },
                   {"mask.png", "32x24", "expected the size of the images, 64x48"});
  ResizeImages(32, 24, camera_, sequence_);
  EXPECT_EQ(ReadMaskAll(path, sequence_, camera_).size(), cv::Size(64, 48));
  const auto full = Write(cv::Mat(48, 64, CV_8UC1, cv::Scalar(255)), "full.png");
  ExpectInputError([&] { ReadMaskAll(full, sequence_, camera_); }, {"64x48", "32x24"});
}

TEST_F(MaskAll, IsResizedAsTheImagesAre) {
  cv::Mat grey(24, 32, CV_8UC1, cv::Scalar(1));
  grey.colRange(8, 32).setTo(0);
  ResizeImages(32, 24, camera_, sequence_);
  for (const ImageSide side : {ImageSide::kLeft, ImageSide::kRight}) {
    const cv::Mat mask = ReadMaskAll(Write(grey), sequence_, camera_, side);
    EXPECT_EQ(cv::countNonZero(mask.colRange(0, 16)), 48 * 16);
    EXPECT_EQ(cv::countNonZero(mask.colRange(16, 64)), 0);
  }
}

// Each image of a pair is rectified in its own way.
TEST_F(MaskAll, IsRectifiedAsTheImagesAre) {
  sequence_.warps = {{.image = [](const cv::Mat& mask, ImageSide side, bool /*is_nearest*/) {
    const int columns = side == ImageSide::kLeft ? 4 : 7;
    cv::Mat rectified(mask.size(), CV_8UC1, cv::Scalar(0));
    mask.colRange(columns, mask.cols).copyTo(rectified.colRange(0, mask.cols - columns));
    rectified.col(mask.cols - columns - 1).setTo(100);  // between used and ignored
    return rectified;
  }}};
  const auto path = Write(cv::Mat(48, 64, CV_8UC1, cv::Scalar(3)));
  EXPECT_EQ(cv::countNonZero(ReadMaskAll(path, sequence_, camera_)), 48 * 59);
  EXPECT_EQ(cv::countNonZero(ReadMaskAll(path, sequence_, camera_, ImageSide::kRight)), 48 * 56);
}

TEST_F(MaskAll, FilesThatAreNoMaskAreRefused) {
  const auto refused = [&](const std::filesystem::path& path, const std::string& part) {
    ExpectInputError([&] { ReadMaskAll(path, sequence_, camera_); },
                     {path.filename().string(), part});
  };
  refused(folder_.path() / "none.png", "");
  refused(folder_.Write("text.png", "255 255 0\n"), "neither a PNG nor a JPEG");
  refused(folder_.Write("empty.png", ""), "empty");
  refused(Write(cv::Mat(48, 64, CV_8UC1, cv::Scalar(255)), "mask.jpg"), "expected a PNG");
  refused(Write(cv::Mat(48, 64, CV_8UC1, cv::Scalar(0)), "black.png"), "black everywhere");
  refused(Write(cv::Mat(48, 64, CV_16UC1, cv::Scalar(900)), "deep.png"), "16 bits");
  const std::string whole = EncodeImage(cv::Mat(48, 64, CV_8UC1, cv::Scalar(255)), ".png");
  refused(folder_.Write("cut.png", whole.substr(0, whole.size() / 2)), "");
}

}  // namespace
}  // namespace hullslam
