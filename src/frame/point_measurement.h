// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "camera/depth_error.h"
#include "hullslam/features/frame_features.h"
#include "hullslam/frame/sensor.h"

namespace hullslam {

// What a keypoint of a frame says about its point, with the errors `error`
// (Sensor::depth_error, or what ForAdjustment makes of it).
PointMeasurement MeasurePoint(const Sensor& sensor, const FrameFeatures& features,
                              uint32_t keypoint, const DepthErrorOptions& error);

}  // namespace hullslam
