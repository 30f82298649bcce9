// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/object_measurement.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(ObjectMeasurement, IsWhatTheDetectionHolds) {
  Detection detection;
  detection.contour = {{0.0, 0.0}, {4.0, 0.0}, {2.0, 1.0}, {0.0, 4.0}};
  detection.hull = {{0.0, 0.0}, {4.0, 0.0}, {0.0, 4.0}};
  detection.lines.resize(5);
  detection.box = {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(4.0, 4.0)};
  const ObjectMeasurement measurement = ToMeasurement(detection);
  EXPECT_EQ(measurement.contour.data(), detection.contour.data());
  EXPECT_EQ(measurement.hull.size(), 3u);
  EXPECT_EQ(measurement.lines.data(), detection.lines.data());
  EXPECT_EQ(measurement.box.max(), Eigen::Vector2d(4.0, 4.0));
  EXPECT_FALSE(measurement.ellipse.has_value());
  detection.ellipse = Ellipse();
  EXPECT_TRUE(ToMeasurement(detection).ellipse.has_value());
}

}  // namespace
}  // namespace hullslam
