// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/make_sensor.h"

namespace hullslam {

Sensor MakeSensor(const SystemOptions& options) {
  options.Validate();
  Sensor sensor;
  sensor.kind = options.sensor;
  sensor.camera = options.camera;
  sensor.bounds = options.camera.UndistortedBounds();
  sensor.levels = ScaleLevels::Create(options.features.level_count, options.features.scale_factor);
  sensor.close_depth = options.depth.close_baselines * sensor.baseline();
  sensor.depth_error = options.depth.error;
  sensor.frames_per_second = options.frames_per_second;
  sensor.readout_time = options.tracking.correct_shutter ? options.readout_time : 0.0;
  sensor.depth_time = options.tracking.correct_shutter && options.sensor == SensorKind::kRgbd
                          ? options.depth.time_offset
                          : 0.0;
  sensor.readout_direction = options.readout_direction;
  sensor.mask_all = options.mask_all;
  sensor.mask_all_right = options.mask_all_right;
  return sensor;
}

}  // namespace hullslam
