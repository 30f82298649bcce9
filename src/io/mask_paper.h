// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/io/mask_source.h"
#include "io/mask_probe.h"

namespace hullslam {

// paper: `segmentation_txt/000012.txt` for the frame numbered 12, with `instance track label
// confidence x1 y1 ... xn yn` a line, of pixels with integer centres; Yu et al. 2025 read these.
// The label is a number or a name.
bool IsPaper(const MaskProbe& probe);
std::unique_ptr<MaskSource> OpenPaper(const MaskRequest& request);

}  // namespace hullslam
