// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "objects/made_objects.h"
#include "objects/resolved_observation.h"

namespace hullslam {

// An object that keyframes on a circle around the world's origin see, with depth.
class SeenByRing {
 public:
  SeenByRing(const MadeObject& object, int keyframes, double step) : object_(map_.AddObject()) {
    for (int i = 0; i < keyframes; ++i) {
      const KeyframeId keyframe =
          AddObserver(map_, sensor_, CameraOnCircle(step * i, 1.5, 0.3 + 0.1 * i), {object});
      map_.AddObservation(object_, keyframe, 0);
    }
  }

  const PinholeCamera& camera() const { return sensor_.camera; }
  std::vector<ResolvedObservation> Observations() const {
    return ResolveObservations(map_, map_.objects().At(object_));
  }

 private:
  Sensor sensor_ = MakeObjectSensor();
  Map map_;
  ObjectId object_;
};

}  // namespace hullslam
