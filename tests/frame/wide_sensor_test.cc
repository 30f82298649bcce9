// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/wide_sensor.h"

#include <gtest/gtest.h>

#include "frame/measure_point.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

TEST(WideSensor, PixelsAndDepthsAreLessPrecise) {
  const SyntheticWorld world;
  const FrameFeatures features = world.Observe(0).frame->features;
  const Sensor wide = WithWideErrors(world.sensor());
  for (const bool is_adjustment : {false, true}) {
    const auto measure = [&](const Sensor& sensor) {
      return MeasurePoint(sensor, features, 0,
                          is_adjustment ? sensor.depth_error.ForAdjustment() : sensor.depth_error);
    };
    EXPECT_TRUE(measure(wide).inverse_sigma.isApprox(measure(world.sensor()).inverse_sigma /
                                                     kWideErrorFactor));
    EXPECT_EQ(measure(wide).measured, measure(world.sensor()).measured);
  }
}

}  // namespace
}  // namespace hullslam
