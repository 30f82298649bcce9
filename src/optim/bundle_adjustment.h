// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "costs/quadric_prior.h"
#include "hullslam/costs/object_residual.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/map/map.h"
#include "hullslam/util/cancellation.h"

namespace hullslam {

// What a bundle adjustment moves and what holds it. Ids are in increasing order.
struct BundleWindow {
  std::vector<KeyframeId> moving;
  std::vector<KeyframeId> fixed;  // observe the landmarks too
  std::vector<LandmarkId> landmarks;
  std::vector<ObjectId> objects;  // their quadrics move too; all of them have a shape
};

// The keyframe and those it shares most landmarks with (at most `max_moving` in all), their
// landmarks, and the keyframes that observe most of these besides (at most `max_fixed`). The root
// of the spanning tree never moves; where nothing would be fixed, the oldest keyframe is. With
// WindowObjects::kMapped also the mapped objects that the moving keyframes observe.
enum class WindowObjects { kNone, kMapped };
BundleWindow LocalWindow(const Map& map, KeyframeId center, size_t max_moving, size_t max_fixed,
                         WindowObjects objects = WindowObjects::kNone);
// Every keyframe, landmark and (if asked for) mapped object; the root of the spanning tree is
// fixed.
BundleWindow GlobalWindow(const Map& map, WindowObjects objects = WindowObjects::kNone);

// How the objects of a window are held. Every detection of an object counts, also those in
// keyframes outside of the window: their poses are fixed, and without them what a few new views
// leave free of a quadric would be lost.
struct ObjectBundleOptions {
  ObjectResidual residual = ObjectResidual::kTangent;
  ObjectPrimitive primitive = ObjectPrimitive::kSupport;
  double sigma_px = 0.5;             // of a line, beside twice the object's misfit: hypot(both)
  double max_effective_lines = 8.0;  // the lines of one detection weigh as so many at most
  double tukey = 6.0;                // sigmas, but at least 15 px: beyond a line counts nothing
  double cauchy = 2.5;               // sigmas: where the loss of a depth point turns
  size_t max_outer_views = 5;        // detections outside of the window, evenly chosen
  double depth_sigma = 0.10;         // m, of depth points about the surface
  size_t max_depth_points = 6;       // of one detection
  double max_effective_points = 1.0;
  // About what the quadric is when the adjustment begins: it damps what the views leave free. About
  // what the object started as, the side that was seen first, it would pull the cameras along.
  QuadricPriorSigmas prior = {};
  QuadricPriorSigmas prior_blind = {.log_axes = 0.15};  // the same of one without depth points
};

// How the problem is solved.
struct BundleOptions {
  int robust_iterations = 5;  // with Huber's loss; then outliers are set aside
  int final_iterations = 10;  // without it, inliers only
  double function_tolerance = 1e-4;
  int threads = 1;  // more than one: results differ in the last bits from run to run
  ObjectBundleOptions objects = {};
};

struct BundleResult {
  std::vector<std::pair<KeyframeId, Rigid3>> poses;
  std::vector<std::pair<LandmarkId, Eigen::Vector3d>> positions;
  std::vector<std::pair<LandmarkId, KeyframeId>> outliers;  // observations to be removed
  std::vector<std::pair<ObjectId, Ellipsoid>> ellipsoids;
  // Objects that came out not finite or with a half axis more than three times larger or smaller:
  // they are left as they were and should be checked.
  std::vector<ObjectId> failed_objects;
  bool is_usable = false;  // false where the solver failed: the other fields are empty
  int residuals = 0;
  int iterations = 0;
};

// Minimises the reprojection errors of the window's landmarks in its keyframes, in Ceres with a
// Schur complement on the points; and with them, for each object of the window,
//   sum over its detections min(1, max_effective_lines / n) sum over n residuals rho(r / sigma)
//   + the same over depth points (DepthAnchorCost) + QuadricPriorCost
// with Tukey's loss rho (Cauchy's for depth) and sigma = ResidualOfPixelError(hypot(sigma_px, 2
// misfit)). Where that fails it is done again without the objects, which are then all among the
// failed ones. Ends early, with what it has, when `cancellation` (may be null) asks; before the
// first round is done it calls no observation an outlier but those of points that are not in front
// of the camera.
BundleResult AdjustBundle(const Map& map, const Sensor& sensor, const BundleWindow& window,
                          const BundleOptions& options, const Cancellation* cancellation);

// Writes the result into the map it was made from, or one that has changed since: what is gone
// meanwhile is passed over.
void ApplyBundle(Map& map, const BundleResult& result, const ScaleLevels& levels);

}  // namespace hullslam
