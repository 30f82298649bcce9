// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "run/datasets/dataset.h"

namespace hullslam {

// A video file, or a folder of images.
std::unique_ptr<Dataset> MakeVideoDataset();

}  // namespace hullslam
