// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "run/datasets/dataset.h"

namespace hullslam {

// Sequences of KITTI's odometry benchmark, of which the left camera is used.
std::unique_ptr<Dataset> MakeKittiLeftDataset();

}  // namespace hullslam
