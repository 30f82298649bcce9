// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/features/feature_set.h"
#include "hullslam/map/map.h"

namespace hullslam {

// Chooses the landmark's descriptor anew: the observed one with the least median distance to the
// others (Mur-Artal and Tardos 2017).
void UpdateDescriptor(Map& map, LandmarkId landmark);

// Viewing direction and the distances between which the landmark can be recognised, from the
// keyframes that observe it and the level at which the reference keyframe does.
void UpdateViewingGeometry(Map& map, LandmarkId landmark, const ScaleLevels& levels);

}  // namespace hullslam
