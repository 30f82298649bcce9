// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/geometry/rigid3.h"
#include "hullslam/util/id.h"

namespace hullslam {

// The pose of a camera relative to a keyframe. It follows the keyframe when the map is adjusted or
// corrected. Map::RelativeTo makes one, Map::CamFromWorld gives its pose in the current map.
struct RelativePose {
  KeyframeId reference;
  Rigid3 cam_from_reference;  // translation in the unit of length that the reference had then
  // Keyframe::scale of the reference when the relative pose was made. If the reference has another
  // scale later, the translation is multiplied by the later scale over this one.
  double reference_scale = 1.0;
};

}  // namespace hullslam
