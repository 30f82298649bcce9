// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/io/mask_source.h"
#include "io/mask_probe.h"

namespace hullslam {

// boxes: `<stem>.txt` with `class x y width height score` a line, of pixels, x and y of the upper
// left corner; EAO-SLAM (Wu et al. 2020) reads these.
bool IsBoxes(const MaskProbe& probe);
std::unique_ptr<MaskSource> OpenBoxes(const MaskRequest& request);

}  // namespace hullslam
