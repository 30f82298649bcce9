// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/texture.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "hullslam/util/check.h"
#include "synthetic/texture_painter.h"

namespace hullslam::synthetic {
namespace {

TEST(Texture, RejectsImagesThatAreNotSquareColourWithAPowerOfTwo) {
  EXPECT_THROW(Texture(cv::Mat(8, 4, CV_8UC3)), CheckError);
  EXPECT_THROW(Texture(cv::Mat(6, 6, CV_8UC3)), CheckError);
  EXPECT_THROW(Texture(cv::Mat(8, 8, CV_8UC1)), CheckError);
  EXPECT_THROW(Texture{cv::Mat()}, CheckError);
}

TEST(Texture, AUniformColourIsTheSameAtAnyPositionAndWidth) {
  const Texture texture(cv::Mat(16, 16, CV_8UC3, cv::Scalar(10, 100, 255)));
  for (const float footprint : {0.0F, 0.07F, 0.4F, 1.0F, 30.0F}) {
    for (const float u : {-3.3F, 0.0F, 0.49F, 7.9F}) {
      const Eigen::Vector3f colour =
          texture.Sample({u, 0.3F - u}, texture.LevelOfDetail(footprint));
      EXPECT_TRUE(colour.isApprox(Eigen::Vector3f(10.0F, 100.0F, 255.0F), 1e-6F)) << colour;
    }
  }
}

TEST(Texture, InterpolatesBetweenTheCentresOfTexels) {
  cv::Mat image(4, 4, CV_8UC3, cv::Scalar(0, 0, 0));
  image.at<cv::Vec3b>(1, 2) = {40, 80, 120};
  const Texture texture(image);
  const Eigen::Vector3f colour(40.0F, 80.0F, 120.0F);
  EXPECT_TRUE(texture.Sample({2.5F / 4, 1.5F / 4}, 0.0F).isApprox(colour));
  EXPECT_TRUE(texture.Sample({2.5F / 4 + 1, 1.5F / 4 - 2}, 0.0F).isApprox(colour));
  EXPECT_TRUE(texture.Sample({3.0F / 4, 1.5F / 4}, 0.0F).isApprox(0.5F * colour));
  EXPECT_TRUE(texture.Sample({2.5F / 4, 1.75F / 4}, 0.0F).isApprox(0.75F * colour));
  // One of the 16 texels has the colour, so the mean of the image is a sixteenth of it.
  EXPECT_NEAR(texture.Sample({0.1F, 0.9F}, texture.LevelOfDetail(1.0F)).y(), 5.0F, 0.6F);
}

TEST(Texture, LevelOfDetailIsTheLogarithmOfTheTexelsCovered) {
  const Texture texture(PaintChecker(1, 64, 8));
  EXPECT_EQ(texture.LevelOfDetail(0.5F / 64), 0.0F);
  EXPECT_NEAR(texture.LevelOfDetail(4.0F / 64), 2.0F, 1e-5F);
  EXPECT_EQ(texture.LevelOfDetail(100.0F), 6.0F);
}

}  // namespace
}  // namespace hullslam::synthetic
