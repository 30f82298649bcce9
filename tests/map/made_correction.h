// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <functional>

#include "hullslam/geometry/sim3.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "support/random_geometry.h"

namespace hullslam {

// A random new_world_from_old_world with a scale from 1 / factor to factor.
inline Sim3 RandomSim3(RandomGeometry& random, double factor = 3.0) {
  const Rigid3 rigid = random.Pose(1.0, 2.0);
  return {std::exp(random.Number(-std::log(factor), std::log(factor))), rigid.rotation,
          rigid.translation};
}

// A correction that names all keyframes of `snapshot` and moves the world around each of them by
// `new_from_old(keyframe)`.
inline MapCorrection MakeCorrection(const Map& snapshot,
                                    const std::function<Sim3(KeyframeId)>& new_from_old) {
  MapCorrection correction;
  correction.snapshot_corrections = snapshot.correction_count();
  snapshot.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    correction.poses.push_back(
        {id, keyframe.cam_from_world, Sim3(keyframe.cam_from_world) * Inverse(new_from_old(id))});
  });
  return correction;
}

// A correction that moves the whole snapshot by the same change.
inline MapCorrection MakeCorrection(const Map& snapshot, const Sim3& new_from_old) {
  return MakeCorrection(snapshot, [&](KeyframeId) { return new_from_old; });
}

// A correction that gives all keyframes of the snapshot the poses that they have.
inline MapCorrection MakeIdentity(const Map& snapshot) {
  MapCorrection correction = MakeCorrection(snapshot, Sim3());
  for (MapCorrection::Pose& pose : correction.poses) {
    pose.corrected_cam_from_world = Sim3(pose.snapshot_cam_from_world);
  }
  return correction;
}

}  // namespace hullslam
