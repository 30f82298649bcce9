// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "frame/rolling_shutter.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/system/options.h"
#include "mesh/voxel_volume.h"
#include "util/task_runner.h"

namespace hullslam {

// x and y of the point at z = 1 that each raw pixel shows, CV_32FC2; (0, 0) and `is_seen` 0 (of
// CV_8UC1) where the camera sees nothing.
cv::Mat RaysOf(const PinholeCamera& camera, cv::Mat& is_seen);

// The poses of the camera while the rows (or columns) of an image were exposed whose middle one has
// the pose `cam_from_world`. Points of the world move with `velocity` in the camera frame. One pose
// for a global shutter.
std::vector<Rigid3> PosesOfRows(const SystemOptions& options, const Rigid3& cam_from_world,
                                const PointVelocity& velocity);

// The weights of a depth image, CV_32FC1 in m. Depths beyond `max_depth` (m) are not used, nor are
// those at borders of surfaces and next to unknown ones, nor surfaces that are seen at a grazing
// angle. The weight of another depth is the cosine of this angle over the variance of the depth
// (DepthErrorOptions). `rays` are those of the camera. The view has no pose and no colour yet.
DepthView MakeDepthView(const cv::Mat& depth, const SystemOptions& options, double max_depth,
                        const cv::Mat& rays, TaskRunner& runner);

}  // namespace hullslam
