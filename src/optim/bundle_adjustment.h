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
#include "optim/bundle_options.h"

namespace hullslam {

// What a bundle adjustment optimises and what it keeps fixed. Ids are in increasing order.
struct BundleWindow {
  std::vector<KeyframeId> moving;
  std::vector<KeyframeId> fixed;  // they observe the landmarks too
  std::vector<LandmarkId> landmarks;
  std::vector<ObjectId> objects;  // their quadrics are optimised; all of them have a shape
};

// The keyframe `center` and those it shares most landmarks with (at most `max_moving` in all) move.
// The window has all landmarks that they observe. Of the other keyframes, those that observe most
// of these landmarks are fixed (at most `max_fixed`; 0: all, so that no observation of a landmark
// is ignored while it moves). The root of the spanning tree never moves. If no keyframe would be
// fixed, the oldest one is. With WindowObjects::kMapped the window also has the mapped objects that
// the moving keyframes observe.
enum class WindowObjects { kNone, kMapped };
BundleWindow LocalWindow(const Map& map, KeyframeId center, size_t max_moving, size_t max_fixed,
                         WindowObjects objects = WindowObjects::kNone);
// The objects that take part in bundle adjustment: the mapped ones, if the options say so.
WindowObjects ObjectsToAdjust(const ObjectOptions& options);
// All keyframes and landmarks of an island and, if asked for, its mapped objects. Only the root of
// the spanning tree is fixed.
BundleWindow GlobalWindow(const Map& map, IslandId island,
                          WindowObjects objects = WindowObjects::kNone);

struct BundleResult {
  std::vector<std::pair<KeyframeId, Rigid3>> poses;
  std::vector<std::pair<LandmarkId, Eigen::Vector3d>> positions;
  std::vector<std::pair<LandmarkId, KeyframeId>> outliers;  // observations to be removed
  std::vector<std::pair<ObjectId, Ellipsoid>> ellipsoids;
  // Objects whose result is not finite, is not in front of all cameras that see it, or has a half
  // axis that changed by more than a factor of three. They keep the shape that they had and should
  // be checked.
  std::vector<ObjectId> failed_objects;
  bool is_usable = false;  // false if the solver failed; then there is no result to apply
  int residuals = 0;       // views of landmarks, and costs on objects
  int iterations = 0;
};

// Minimises the reprojection errors of the window's landmarks in its keyframes. Without depth, the
// options are those of WithoutDepth(), the standard deviations of keypoints are made as small as
// the errors show them to be, keypoints at the same place share a weight (SharesOfPlaces), and
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

// Writes the result into the map that it was computed from. The map may have changed since then:
// what no longer exists is passed over.
void ApplyBundle(Map& map, const BundleResult& result, const ScaleLevels& levels);

}  // namespace hullslam
