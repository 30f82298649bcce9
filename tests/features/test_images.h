// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "support/test_data.h"

namespace hullslam {

// Random bright and dark boxes and discs with some noise, which give corners of all strengths and
// scales.
inline cv::Mat MakeCornerImage(int width = 640, int height = 480, uint64_t seed = 7) {
  cv::Mat image(height, width, CV_8UC1, cv::Scalar(120));
  cv::RNG random(seed);
  for (int i = 0; i < 260; ++i) {
    const cv::Point position(random.uniform(0, width), random.uniform(0, height));
    const cv::Scalar grey(random.uniform(0, 256));
    if (i % 3 == 0) {
      cv::circle(image, position, random.uniform(3, 25), grey, cv::FILLED);
    } else {
      const cv::Size size(random.uniform(4, 60), random.uniform(4, 60));
      cv::rectangle(image, cv::Rect(position, size), grey, cv::FILLED);
    }
  }
  cv::Mat noise(image.size(), CV_16SC1);
  random.fill(noise, cv::RNG::NORMAL, 0.0, 4.0);
  cv::add(image, noise, image, cv::noArray(), CV_8UC1);
  return image;
}

// A straight upright edge. Weak dots beside it are corners, but only the edge gives them a
// position.
inline cv::Mat MakeDottedEdge(int width, int height) {
  cv::Mat image(height, width, CV_8UC1, cv::Scalar(60));
  image.colRange(width / 2, width).setTo(200);
  for (int y = 2; y < height; y += 12) {
    image.at<uint8_t>(y, width / 2 - 3) = 85;
  }
  return image;
}

// A grey image of TUM freiburg1_xyz; empty if the data is not on this machine.
inline cv::Mat LoadRealImage() {
  const auto path = FindTestData("fr1_xyz/rgb/1305031102.175304.jpg");
  return path ? cv::imread(path->string(), cv::IMREAD_GRAYSCALE) : cv::Mat();
}

}  // namespace hullslam
