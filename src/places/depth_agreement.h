// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// The number of depth samples of one image that another image with depth confirms, and of those
// that it contradicts, because its camera sees past them.
struct DepthAgreement {
  int surface = 0;
  int past = 0;

  void Add(const DepthAgreement& other) {
    surface += other.surface;
    past += other.past;
  }
  int compared() const { return surface + past; }
};

// Compares the depth samples of each of the two frames with the depth image of the other one. Both
// numbers are 0 without depth. Something nearer that hides a sample says nothing. `tolerance`
// multiplies the error of depths.
DepthAgreement CompareDepths(const Sensor& sensor, const Frame& a, const Frame& b,
                             const Rigid3& b_from_a, double tolerance = 1.0);

}  // namespace hullslam
