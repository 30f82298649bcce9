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

// The sensor with larger errors of keypoints and depths, for images that are taken far apart.
// Landmarks are then seen from elsewhere, so errors of their depths show in the image, and so do
// those of the calibration and of a rolling shutter. In a recording of a phone with depth,
// landmarks are 1.7 px and 1 to 6 px of disparity from where the depth of one keyframe says, three
// times as far as in the next image of a video.
inline constexpr double kWideErrorFactor = 3.0;
Sensor WithWideErrors(Sensor sensor);

}  // namespace hullslam
