// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/util/option_table.h"

namespace hullslam {

struct MappingOptions {
  bool cull_keyframes = true;

  void Bind(OptionTable& options);
};

}  // namespace hullslam
