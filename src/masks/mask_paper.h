// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "masks/mask_format.h"

namespace hullslam {

// Format paper: `segmentation_txt/000012.txt` for frame number 12, with one line `instance track
// label confidence x1 y1 ... xn yn` per instance, in pixels whose centres are integers. Yu et al.
// 2025 read these files. The label is a number or a name.
extern const MaskFormat kPaperFormat;

}  // namespace hullslam
