// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "masks/mask_format.h"

namespace hullslam {

// Format boxes: `<stem>.txt` with one line per box, in one of two forms. The first box of the
// folder decides which.
// - `class x y width height score` in pixels; x and y are the upper left corner. EAO-SLAM reads
//   these files (Wu et al. 2020).
// - `class x y width height [confidence]` in shares of the image; x and y are the centre. YOLO
//   writes these files for detections (Ultralytics, save_txt).
// In the second form, the number of a track may be the last column (`yolo detect track`).
extern const MaskFormat kBoxesFormat;

// Whether the first line is one of the second form with both a confidence and a track. It has as
// many numbers as an outline of three points.
bool IsTrackedBox(const MaskProbe& probe);

}  // namespace hullslam
