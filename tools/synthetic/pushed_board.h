// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/geometry/rigid3.h"
#include "synthetic/object_models.h"

namespace hullslam::synthetic {

// A printed board of 25 x 20 cm that leans back, and the forearm that holds it from behind. It
// faces -y. No segmentation network has a class for it.
ObjectBuilder MakePushedBoard(const Material& print, const Material& skin);

// A thing that is pushed from place to place: it rests, moves, rests, and so on.
struct PushedPath {
  std::vector<Eigen::Vector3d> places;  // of the centre of the thing, m
  double rest = 1.5;                    // s at each place, except that it stays at the last one
  double move = 0.6;                    // s from one place to the next
  Rigid3 WorldFromThing(double time) const;
};

}  // namespace hullslam::synthetic
