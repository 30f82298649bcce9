// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/util/option_table.h"

namespace hullslam {

// ORB features as in ORB-SLAM2 (Mur-Artal and Tardos 2017).
struct FeatureOptions {
  int feature_count = 1000;
  double scale_factor = 1.2;
  int level_count = 8;
  int initial_fast_threshold = 20;  // grey levels
  int minimum_fast_threshold = 7;   // for cells that have no corner at the initial threshold

  bool subpixel = false;  // refine positions to a fraction of a pixel

  // Binds the fields to ORB-SLAM2's keys `ORBextractor.nFeatures` and so on, and to
  // `ORBextractor.subpixel`.
  void Bind(OptionTable& options);
};

}  // namespace hullslam
