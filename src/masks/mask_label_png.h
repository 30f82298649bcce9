// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "masks/mask_format.h"

namespace hullslam {

// Format label-png: `<stem>.png` with 16 bits per pixel, which contain the number of the instance,
// 0 for none; and classes.json with the classes of the instances: {"1": "cup", "2": {"class": "tv",
// "score": 0.9}} for all frames and, with precedence, {"frames": {"<stem>": {"1": "mouse"}}} for
// one frame.
extern const MaskFormat kLabelPngFormat;

}  // namespace hullslam
