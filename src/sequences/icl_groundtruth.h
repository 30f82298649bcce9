// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>

#include "hullslam/camera/depth.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/trajectory.h"
#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

constexpr double kIclFramesPerSecond = 30.0;

// The pose of the right-handed camera (y down) that sees the same pixels in the mirrored world as a
// camera with y up at the given pose. With F = diag(1, -1, 1) it is F R F, F t. A pixel of the
// camera with y up is v = cy - fy Y / Z; with the point F X of the mirrored world, whose y is -Y,
// it is v = cy + fy Y' / Z'.
Rigid3 MirrorY(const Rigid3& world_from_cam);
Trajectory MirrorY(Trajectory trajectory);

// A trajectory in TUM's format whose time stamps are the indices of frames. The result has index /
// 30 s. Throws InputError as ReadTrajectory(), and for a stamp that is not an index.
Trajectory ReadIndexedTrajectory(const std::filesystem::path& path);

// How well two ground truths explain the depth images.
struct YAxisVotes {
  size_t pixels = 0;     // that were compared
  size_t both = 0;       // those of them whose depth both predict
  size_t only_up = 0;    // those whose depth only the poses of cameras with y up predict
  size_t only_down = 0;  // the same for y down
};

// Predicts depth images from others about half a second earlier, with the poses as they are (y
// down) and mirrored (y up). Frames without depth or pose, and images that cannot be read, are
// passed over.
YAxisVotes MeasureYAxis(const ImageSequence& sequence, const Trajectory& as_given,
                        const PinholeCamera& camera, const DepthOptions& depth);

}  // namespace hullslam
