// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/io/mask_source.h"
#include "io/mask_probe.h"

namespace hullslam {

// Format boxes: `<stem>.txt` with one line `class x y width height score` per box, in pixels; x and
// y are the upper left corner. EAO-SLAM (Wu et al. 2020) reads these files.
bool IsBoxes(const MaskProbe& probe);
std::unique_ptr<MaskSource> OpenBoxes(const MaskRequest& request);

}  // namespace hullslam
