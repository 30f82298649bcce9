// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "masks/mask_format.h"

namespace hullslam {

// Format yolo-seg: `<stem>.txt` with one line `class x1 y1 ... xn yn [confidence]` per instance;
// coordinates are fractions of width and height.
extern const MaskFormat kYoloSegFormat;

}  // namespace hullslam
