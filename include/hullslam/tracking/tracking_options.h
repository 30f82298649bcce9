// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/util/option_table.h"

namespace hullslam {

struct TrackingOptions {
  int lost_after_frames =
      30;  // a run without relocalisation is given up after that many lost frames

  void Bind(OptionTable& options);
};

}  // namespace hullslam
