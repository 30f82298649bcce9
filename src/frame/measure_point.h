// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "camera/point_measurement.h"
#include "hullslam/features/frame_features.h"
#include "hullslam/frame/sensor.h"

namespace hullslam {

// The measurement of a point by a keypoint of a frame. `error` is Sensor::depth_error, or the
// result of its ForAdjustment() for bundle adjustment.
PointMeasurement MeasurePoint(const Sensor& sensor, const FrameFeatures& features,
                              uint32_t keypoint, const DepthErrorOptions& error);

}  // namespace hullslam
