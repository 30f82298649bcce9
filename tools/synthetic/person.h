// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synthetic/object_models.h"

namespace hullslam::synthetic {

// A standing person, 1.75 m tall, of ellipsoids. It faces -y.
ObjectBuilder MakePerson(const Material& shirt, const Material& trousers, const Material& skin);

// A walk on a circle around the origin with two stops, always facing along the path.
struct StrollPath {
  double radius = 1.05;       // metres
  double start_angle = 1.7;   // radians from +x
  double swept_angle = -2.6;  // radians
  double duration = 10.0;     // seconds
  // Pose of the person, whose feet are on z = 0, at a time; `half_height` is half of the height.
  // The person stays at the end after `duration`.
  Rigid3 WorldFromPerson(double time, double half_height) const;
};

}  // namespace hullslam::synthetic
