// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/point_colours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "support/synthetic_world.h"

namespace hullslam {
namespace {

TEST(PointColours, AreMeansOverTheImages) {
  const SyntheticWorld world;
  const SyntheticMap made = MakeSyntheticMap(world, {0, 10});
  std::vector<LandmarkId> ids;
  made.map.landmarks().ForEach([&](LandmarkId id, const Landmark&) { ids.push_back(id); });
  PointColours colours(made.map, ids);
  EXPECT_EQ(colours.Colours().at(0), (Colour{128, 128, 128}));
  const PinholeCamera& camera = world.sensor().camera;
  const cv::Size size(camera.width, camera.height);
  colours.Add(KeyframeId(0), cv::Mat(size, CV_8UC3, cv::Scalar(10, 20, 30)), camera);
  colours.Add(KeyframeId(1), cv::Mat(size, CV_8UC3, cv::Scalar(20, 40, 60)), camera);
  const std::vector<Colour> list = colours.Colours();
  ASSERT_EQ(list.size(), ids.size());
  // All landmarks are seen in both images; blue comes first in the images, red in the colours.
  for (const Colour& colour : list) {
    EXPECT_EQ(colour, (Colour{45, 30, 15}));
  }
}

TEST(PointColours, AreThoseOfTheKeypoint) {
  const SyntheticWorld world;
  const SyntheticMap made = MakeSyntheticMap(world, {0, 10});
  const Keyframe& keyframe = made.map.keyframes().At(KeyframeId(0));
  const auto found = std::find_if(keyframe.landmarks.begin(), keyframe.landmarks.end(),
                                  [](LandmarkId id) { return id.IsValid(); });
  ASSERT_NE(found, keyframe.landmarks.end());
  const std::vector<LandmarkId> ids = {*found};
  const Eigen::Vector2f pixel =
      keyframe.frame->features.keypoints[static_cast<size_t>(found - keyframe.landmarks.begin())]
          .undistorted;
  const PinholeCamera& camera = world.sensor().camera;
  cv::Mat image = cv::Mat::zeros(camera.height, camera.width, CV_8UC3);
  const cv::Point center(static_cast<int>(std::lround(pixel.x())),
                         static_cast<int>(std::lround(pixel.y())));
  image(cv::Rect(center - cv::Point(1, 1), cv::Size(3, 3)) & cv::Rect({}, image.size())) =
      cv::Scalar(0, 0, 200);
  PointColours colours(made.map, ids);
  colours.Add(KeyframeId(0), image, camera);
  EXPECT_EQ(colours.Colours()[0], (Colour{200, 0, 0}));
}

}  // namespace
}  // namespace hullslam
