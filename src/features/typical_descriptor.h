// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "hullslam/features/feature_set.h"

namespace hullslam {

// Index of the descriptor with the least median Hamming distance to the others; ties go to the
// first (Mur-Artal and Tardos 2017). Returns 0 for an empty list.
size_t MostTypicalDescriptor(std::span<const Descriptor> descriptors);

}  // namespace hullslam
