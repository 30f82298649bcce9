// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/objects/object_constraint_options.h"

namespace hullslam {

std::vector<std::string> RobustLossNames() { return {"none", "huber", "cauchy", "tukey"}; }

std::vector<std::string> SigmaUnitNames() { return {"pixels", "residual"}; }

}  // namespace hullslam
