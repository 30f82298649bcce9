// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/util/option_table.h"

namespace hullslam {

struct MappingOptions {
  int local_keyframes = 20;  // that local bundle adjustment moves, at most
  int fixed_keyframes = 20;  // that hold it, at most
  bool cull_keyframes = true;
  bool final_bundle_adjustment = true;  // of the whole map, at the end

  void Bind(OptionTable& options);
};

}  // namespace hullslam
