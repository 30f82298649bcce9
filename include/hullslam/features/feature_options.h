// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/util/option_table.h"

namespace hullslam {

// ORB features as in ORB-SLAM2 (Mur-Artal and Tardos 2017). The defaults are those for images of
// 640x480 px.
struct FeatureOptions {
  // Least side of the smallest level of the pyramid, px: a patch with its border needs half of it
  // on each side of a corner.
  static constexpr int kSmallestSide = 64;

  int feature_count = 1000;
  double scale_factor = 1.2;
  int level_count = 8;
  int initial_fast_threshold = 20;  // grey levels
  int minimum_fast_threshold = 7;   // for cells that have no corner at the initial threshold

  bool subpixel = true;  // refine positions to a fraction of a pixel
  // Keep corners on straight edges, whose positions along the edge are uncertain. Frames with depth
  // always keep them (FrameBuilder): depth holds their landmarks, and they hold poses across the
  // edge.
  bool keep_edges = false;

  // The largest number of levels for images of this size; 0 if they are smaller than one level.
  int MostLevels(int width, int height) const;
  // The numbers of levels and of features that suit images of this size.
  int LevelsFor(int width, int height) const;
  int FeaturesFor(int width, int height) const;

  // Binds the fields to ORB-SLAM2's keys `ORBextractor.nFeatures` and so on, and to
  // `ORBextractor.subpixel` and `ORBextractor.keepEdges`.
  void Bind(OptionTable& options);
};

}  // namespace hullslam
