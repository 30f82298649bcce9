// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/masks/mask_source.h"
#include "masks/mask_probe.h"

namespace hullslam {

// Format yolo-seg: `<stem>.txt` with one line `class x1 y1 ... xn yn [confidence]` per instance;
// coordinates are fractions of width and height.
bool IsYoloSeg(const MaskProbe& probe);
std::unique_ptr<MaskSource> OpenYoloSeg(const MaskRequest& request);

}  // namespace hullslam
