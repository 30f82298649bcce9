// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>

#include "hullslam/camera/depth.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/trajectory.h"
#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// Converts the pose (R, t) of a camera whose y axis points up to a right-handed camera (y
// down) that sees the same pixels in the mirrored world. With F = diag(1, -1, 1) the new pose is (F
// R F, F t): a point X of the world becomes F X, and X_c in the camera frame becomes F X_c. So the
// row v = cy - fy Y / Z of the camera with y up is cy + fy Y' / Z' with Y' = -Y and Z' = Z.
Rigid3 MirrorY(const Rigid3& world_from_cam);
Trajectory MirrorY(Trajectory trajectory);

constexpr double kIclFramesPerSecond = 30.0;

// Reads a trajectory in TUM's format whose time stamps are the indices of frames. The stamps of the
// result are index / 30 s. Throws InputError like ReadTrajectory(), and for a stamp that is not an
// index.
Trajectory ReadIndexedTrajectory(const std::filesystem::path& path);

// How well two ground truths explain the depth images.
struct YAxisVotes {
  size_t pixels = 0;     // number of compared pixels
  size_t both = 0;       // pixels whose depth is predicted with y up and with y down
  size_t only_up = 0;    // pixels whose depth is predicted with y up only
  size_t only_down = 0;  // pixels whose depth is predicted with y down only
};

// Predicts depth images from those about half a second earlier, with the poses as they are (y down)
// and mirrored (y up), and compares the predictions with the measured depth. Frames without depth
// or pose, and images that cannot be read, are skipped.
YAxisVotes MeasureYAxis(const ImageSequence& sequence, const Trajectory& as_given,
                        const PinholeCamera& camera, const DepthOptions& depth);

}  // namespace hullslam
