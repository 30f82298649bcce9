// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/mapping/mapping_options.h"

namespace hullslam {

void MappingOptions::Bind(OptionTable& options) {
  options.Add("mapping.cull_keyframes", &cull_keyframes, "remove redundant keyframes");
}

}  // namespace hullslam
