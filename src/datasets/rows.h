// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/datasets/dataset.h"

namespace hullslam {

// The rows of the table of data sets, each in the file with its name.
Dataset TumDataset();
Dataset IclDataset();
Dataset EurocDataset();  // the left camera
Dataset EurocStereoDataset();
Dataset KittiLeftDataset();
Dataset KittiDataset();
Dataset StereoFolderDataset();
Dataset BagDataset();
Dataset StereoBagDataset();
Dataset VslamLabDataset();
Dataset VideoDataset();

}  // namespace hullslam
