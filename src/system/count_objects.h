// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>

#include "hullslam/frame/built_frame.h"
#include "hullslam/system/system.h"
#include "objects/validity.h"

namespace hullslam {

// The counts of a run of `frames` frames, with the names of the reasons as in summary.json.
ObjectCounts CountObjects(const DetectionCounts& masks, size_t frames,
                          const std::map<ObjectRejection, size_t>& rejections);

}  // namespace hullslam
