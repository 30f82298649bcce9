// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "run/datasets/dataset.h"

namespace hullslam {

// Recordings of ROS 1 and ROS 2, with or without their depth images.
std::unique_ptr<Dataset> MakeBagDataset();

}  // namespace hullslam
