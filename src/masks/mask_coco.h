// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/masks/mask_source.h"
#include "masks/mask_probe.h"

namespace hullslam {

// Format coco: a JSON file with results or instances in the format of COCO (cocodataset.org), with
// polygons or run lengths, else boxes. It also reads the files that SAM and Ultralytics write.
bool IsCoco(const MaskProbe& probe);
std::unique_ptr<MaskSource> OpenCoco(const MaskRequest& request);

}  // namespace hullslam
