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

// Throws InputError that begins with `path` for pairs that cannot be used: swapped, twice the same
// image, not rectified. Some pairs of the sequence are looked at.
void CheckPairs(const std::filesystem::path& path, const ImageSequence& sequence,
                const PinholeCamera& camera);

}  // namespace hullslam
