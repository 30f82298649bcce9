// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "run/datasets/dataset.h"

namespace hullslam {

// The left camera of sequences of EuRoC.
std::unique_ptr<Dataset> MakeEurocDataset();

}  // namespace hullslam
