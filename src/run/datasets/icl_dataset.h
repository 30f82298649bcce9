// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "run/datasets/dataset.h"

namespace hullslam {

// Sequences of ICL-NUIM, of either package.
std::unique_ptr<Dataset> MakeIclDataset();

}  // namespace hullslam
