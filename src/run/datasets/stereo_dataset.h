// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>

#include "run/datasets/dataset.h"

namespace hullslam {

// The data sets of stereo cameras: EuRoC's, KITTI's, folders or videos of pairs, and recordings of
// ROS.
std::unique_ptr<Dataset> MakeEurocStereoDataset();
std::unique_ptr<Dataset> MakeKittiDataset();
std::unique_ptr<Dataset> MakeStereoFolderDataset();
std::unique_ptr<Dataset> MakeStereoBagDataset();

}  // namespace hullslam
