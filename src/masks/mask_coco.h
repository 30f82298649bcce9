// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "masks/mask_format.h"

namespace hullslam {

// Format coco: a JSON file with results or instances in the format of COCO (cocodataset.org), with
// polygons or run lengths, else boxes. It also reads the files that SAM and Ultralytics write.
extern const MaskFormat kCocoFormat;

}  // namespace hullslam
