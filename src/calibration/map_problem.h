// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "calibration/camera_problem.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/trajectory.h"
#include "hullslam/map/map.h"

namespace hullslam {

// The camera of a run. `disparity_offset` is that of its depth images (DepthOptions), whose depths
// in the map are without it.
CameraModel ModelOf(const Sensor& sensor, double disparity_offset);

// The calibration of the camera of a finished run without objects: its keyframes and the landmarks
// that enough of them see. Velocities are those of `trajectory`, which has the poses of all frames;
// if most keyframes have no neighbours in it, all velocities are zero. Long runs give at most 150
// keyframes, evenly chosen, and 6000 landmarks.
CalibrationProblem MakeProblem(const Map& map, const Sensor& sensor, const CameraModel& model,
                               const Trajectory& trajectory);

}  // namespace hullslam
