// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "masks/mask_format.h"

namespace hullslam {

// Format label-png. `<stem>.png` has the number of the instance in each pixel, 0 for none: grey
// with 8 or 16 bits, or the indices of a palette.
// classes.json has the classes of the instances: {"1": "cup", "2": {"class": "tv", "score": 0.9}}
// for all frames. {"frames": {"<stem>": {"1": "mouse"}}} is for one frame and takes precedence.
extern const MaskFormat kLabelPngFormat;

}  // namespace hullslam
