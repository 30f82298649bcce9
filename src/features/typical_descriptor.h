// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "hullslam/features/feature_set.h"

namespace hullslam {

// The index of the descriptor whose median Hamming distance to the others is least; the first of
// equals, 0 for none (Mur-Artal and Tardos 2017).
size_t MostTypicalDescriptor(std::span<const Descriptor> descriptors);

}  // namespace hullslam
