// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/util/cancellation.h"
#include "optim/bundle_options.h"
#include "optim/bundle_result.h"
#include "optim/bundle_window.h"

namespace hullslam {

// Minimises the reprojection errors of the window's landmarks in its keyframes. Without depth, the
// options are those of ForMonocular(), the standard deviations of keypoints are made as small as
// the errors show them to be, keypoints at the same position share a weight (KeypointWeights), and
// Cauchy's loss is used in both rounds. Ceres solves for poses and objects. In a small window own
// code eliminates the landmarks (EliminatedPoints); in a large one, Ceres does so
// (BundleOptions::max_eliminated), and after each step the objects alone follow the poses. Each
// object of the window adds the constraints of its detections (MakeObjectConstraint) and a prior
// (MakeObjectPrior) at the shape that it has at the beginning. A view in which the object reaches
// the plane of the camera is left out. If the solver fails, the adjustment is repeated without
// objects, and all objects are reported as failed. With a monocular sensor and a single fixed
// keyframe the result has the scale of the map (KeepScale). If `cancellation` (may be null) is
// requested, the adjustment ends early and returns what it has. If that happens in the first round,
// the only outliers are observations of points that are not in front of the camera. `on_progress`
// is called after each iteration.
BundleResult AdjustBundle(const Map& map, const Sensor& sensor, const BundleWindow& window,
                          const BundleOptions& options, const Cancellation* cancellation,
                          const ProgressCallback& on_progress = {});

}  // namespace hullslam
