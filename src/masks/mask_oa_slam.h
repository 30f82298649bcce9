// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "masks/mask_format.h"

namespace hullslam {

// Format oa-slam: a JSON file with a list of {"file_name", "detections": [{"category_id",
// "detection_score", "bbox": [x1, y1, x2, y2]}]}, which OA-SLAM (Zins et al. 2022) reads. A
// detection may also have an "ellipse": [cx, cy, a, b, angle], as in VOOM (Wang et al. 2024).
extern const MaskFormat kOaSlamFormat;

}  // namespace hullslam
