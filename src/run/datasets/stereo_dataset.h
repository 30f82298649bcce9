// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "run/datasets/dataset.h"

namespace hullslam {

// The data sets of stereo cameras: EuRoC's, KITTI's, and folders or videos of pairs.
std::unique_ptr<Dataset> MakeEurocStereoDataset();
std::unique_ptr<Dataset> MakeKittiDataset();
std::unique_ptr<Dataset> MakeStereoFolderDataset();

}  // namespace hullslam
