// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/make_sensor.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace hullslam {
namespace {

SystemOptions SensorOptions() {
  SystemOptions options;
  options.camera = {.fx = 500.0, .fy = 510.0, .cx = 320.0, .cy = 240.0, .bf = 40.0};
  options.readout_time = 0.02;
  return options;
}

TEST(MakeSensor, HasThePropertiesOfTheOptions) {
  SystemOptions options = SensorOptions();
  options.features.level_count = 5;
  options.features.scale_factor = 1.3;
  options.depth.close_baselines = 30.0;
  const Sensor sensor = MakeSensor(options);
  EXPECT_EQ(sensor.kind, SensorKind::kRgbd);
  EXPECT_EQ(sensor.camera.fy, 510.0);
  EXPECT_EQ(sensor.levels.count(), 5);
  EXPECT_FLOAT_EQ(sensor.levels.scale[1], 1.3f);
  EXPECT_DOUBLE_EQ(sensor.baseline(), 40.0 / 500.0);
  EXPECT_DOUBLE_EQ(sensor.close_depth, 30.0 * 40.0 / 500.0);
  EXPECT_EQ(sensor.bounds.max_x, options.camera.UndistortedBounds().max_x);
}

TEST(MakeSensor, AMonocularCameraHasNoClosePoints) {
  SystemOptions options = SensorOptions();
  options.sensor = SensorKind::kMonocular;
  EXPECT_EQ(MakeSensor(options).close_depth, 0.0);
}

TEST(MakeSensor, TheShutterIsGlobalUnlessItIsCorrected) {
  SystemOptions options = SensorOptions();
  options.tracking.correct_shutter = true;
  EXPECT_EQ(MakeSensor(options).readout_time, 0.02);
  options.tracking.correct_shutter = false;
  EXPECT_EQ(MakeSensor(options).readout_time, 0.0);
}

TEST(MakeSensor, OptionsThatCannotBeUsedAreRefused) {
  SystemOptions options = SensorOptions();
  options.camera.fx = 0.0;
  ExpectInputError([&] { MakeSensor(options); }, {"Camera.fx"});
}

}  // namespace
}  // namespace hullslam
