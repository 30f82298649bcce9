// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "masks/mask_format.h"

namespace hullslam {

// Format json: a folder with `<stem>.json` for each image, in one of three forms: a list of masks
// (Segment Anything), an object with the list "annotations" of COCO's form (SA-1B), or an object
// with the list "shapes" (LabelMe and its followers).
extern const MaskFormat kJsonFolderFormat;

}  // namespace hullslam
