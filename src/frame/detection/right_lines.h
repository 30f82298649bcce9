// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/detection.h"

namespace hullslam {

// Gives each detection of the left image of a rectified pair (`camera`) the lines of the detection
// of the right image that shows the same object (Detection::right_lines). The two have one label,
// and their hulls have an IoU of more than 0.5 when the left one is shifted by the disparity of its
// depth points, or, without these, such that the middles of the two boxes have the same column. Two
// masks without common pixels cannot both have such an IoU with a third one, so each detection
// belongs to one of the other image. Returns the number of detections that got lines.
size_t AddLinesOfRight(std::span<const Detection> right, const PinholeCamera& camera,
                       std::vector<Detection>& left);

}  // namespace hullslam
