// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"
#include "hullslam/util/cancellation.h"
#include "optim/bundle_options.h"
#include "optim/bundle_result.h"
#include "optim/bundle_window.h"

namespace hullslam {

// Minimises the reprojection errors of the window's landmarks in its keyframes, in two rounds. The
// second round leaves out the outliers of the first.
//
// Our own code eliminates the landmarks (EliminatedPoints), and Ceres solves for poses and objects.
// Each object of the window adds the constraints of its detections (MakeObjectConstraint) and a
// prior at its initial shape (MakeObjectPrior). An observation in which the object reaches the
// plane of the camera is left out. If the solver fails, the adjustment is repeated without objects,
// and all objects are reported as failed.
//
// A monocular sensor differs in five points: the options are those of ForMonocular(); the standard
// deviations of keypoints are reduced to those that the errors show (MeasureKeypointPrecision);
// keypoints at the same position share a weight (KeypointWeights); both rounds use Cauchy's loss;
// and with a single fixed keyframe the result keeps the scale of the map (KeepScale).
//
// If `cancellation` (may be null) is requested, the adjustment ends early and returns its current
// result. If that happens in the first round, the only outliers are observations of points that are
// not in front of the camera. `on_progress` is called after each iteration.
BundleResult AdjustBundle(const Map& map, const Sensor& sensor, const BundleWindow& window,
                          const BundleOptions& options, const Cancellation* cancellation,
                          const ProgressCallback& on_progress = {});

struct IslandAdjustment {
  BundleResult result;
  std::vector<ObjectId> objects;  // that took part, by increasing id
};

// Global bundle adjustment of an island: of its landmarks, of all its keyframes but the root of the
// spanning tree and, if the options say so, of its mapped objects (GlobalWindow, AdjustBundle). The
// map is not changed.
IslandAdjustment AdjustIsland(const Map& map, IslandId island, const Sensor& sensor,
                              const ObjectOptions& options, const Cancellation* cancellation,
                              const ProgressCallback& on_progress = {});

}  // namespace hullslam
