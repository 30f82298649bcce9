// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/util/option_table.h"

namespace hullslam {

// Loop closing: the conditions under which the camera is back at a place that it has seen before,
// and under which the correction of the map is accepted.
struct LoopOptions {
  bool enabled = true;

  // Least numbers of matching landmarks: with the candidate alone, and with its neighbourhood.
  int min_matches = 20;
  int min_landmarks = 40;
  // If fewer neighbours of the query look like the candidate's place (temporal and covisibility
  // consistency), twice as many landmarks are needed.
  int min_supporters = 2;

  // The drift budget (as in OKVIS2, Leutenegger 2022): the largest translation and rotation of the
  // query by a correction, relative to the length of the camera's way and the sum of its rotations
  // since the candidate. Without depth, the median depth of the scene counts as a metre.
  double drift_base = 0.2;         // m
  double drift_per_metre = 0.05;   // m
  double drift_per_radian = 0.02;  // m
  double turn_base = 0.1;          // radians
  double turn_per_metre = 0.02;    // radians
  double turn_per_radian = 0.03;   // radians
  bool object_votes = true;        // whether mapped objects speak for or against a loop
  bool global_adjustment = true;   // adjust the whole map after a loop was closed

  void Bind(OptionTable& options);
};

}  // namespace hullslam
