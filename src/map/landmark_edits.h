// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "hullslam/features/feature_set.h"
#include "hullslam/map/map.h"

namespace hullslam {

// Index of the descriptor with the least median Hamming distance to the others; ties go to the
// first (Mur-Artal and Tardos 2017). Returns 0 for an empty list.
size_t MostTypicalDescriptor(std::span<const Descriptor> descriptors);

// Sets the landmark's descriptor to the observed one with the smallest median distance to the
// others (Mur-Artal and Tardos 2017).
void UpdateDescriptor(Map& map, LandmarkId landmark);

// Sets the viewing direction and the range of distances in which the landmark can be recognised.
// They follow from the keyframes that observe it and from the level at which the reference keyframe
// observes it.
void UpdateViewingGeometry(Map& map, LandmarkId landmark, const ScaleLevels& levels);

}  // namespace hullslam
