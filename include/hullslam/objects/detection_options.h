// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/costs/object_residual.h"
#include "hullslam/util/option_table.h"

namespace hullslam {

// How masks become outlines and lines.
struct DetectionOptions {
  ObjectPrimitive primitive = ObjectPrimitive::kSupport;
};

}  // namespace hullslam
