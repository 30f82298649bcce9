// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "run/datasets/dataset.h"

namespace hullslam {

// Sequences in the format of TUM RGB-D, with or without their depth images.
std::unique_ptr<Dataset> MakeTumDataset();

}  // namespace hullslam
