// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"
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
// Schur complement on the points; and with them, for each object of the window, the constraints of
// its detections (MakeObjectConstraint) and its prior (MakeObjectPrior) about what it is when the
// adjustment begins. Where that fails it is done again without the objects, which are then all
// among the failed ones. Ends early, with what it has, when `cancellation` (may be null) asks;
// before the first round is done it calls no observation an outlier but those of points that are
// not in front of the camera.
BundleResult AdjustBundle(const Map& map, const Sensor& sensor, const BundleWindow& window,
                          const BundleOptions& options, const Cancellation* cancellation);

// Writes the result into the map it was made from, or one that has changed since: what is gone
// meanwhile is passed over.
void ApplyBundle(Map& map, const BundleResult& result, const ScaleLevels& levels);

}  // namespace hullslam
