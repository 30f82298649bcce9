// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/wide_sensor.h"

namespace hullslam {

Sensor WithWideErrors(Sensor sensor) {
  sensor.depth_error.pixel_sigma *= kWideErrorFactor;
  sensor.depth_error.adjustment_pixel_sigma *= kWideErrorFactor;
  sensor.depth_error.disparity_sigma *= kWideErrorFactor;
  return sensor;
}

}  // namespace hullslam
