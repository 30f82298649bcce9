// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/detection.h"

namespace hullslam {

// Raw px per undistorted px, across a line with this normal, at an undistorted pixel. A line n.x +
// c = 0 has the gradient J^-T n in the raw image, with the derivative J of the distortion.
double RawShare(const PinholeCamera& camera, const Eigen::Vector2d& undistorted,
                const Eigen::Vector2d& normal);

// The lines with normals and offsets such that TangentDistance() is a distance in the raw image of
// a fisheye lens, to first order, where the line touches the hull; without such a lens as they are.
std::vector<SilhouetteLine> ScaleToRaw(const PinholeCamera& camera, const Detection& detection,
                                       std::span<const SilhouetteLine> lines);

}  // namespace hullslam
