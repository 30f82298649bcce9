// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/iteration_callback.h>
#include <ceres/ordered_groups.h>
#include <ceres/problem.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "costs/manifolds.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/map/map.h"
#include "optim/bundle_result.h"
#include "optim/bundle_window.h"
#include "optim/object_sum_cost.h"
#include "util/id_set.h"

namespace hullslam::internal {

// The index of the pose of each keyframe of a window. The poses of moving keyframes come before
// those of fixed ones.
using PoseIndices = IdMap<KeyframeId, size_t>;
PoseIndices IndexPoses(const BundleWindow& window);

// The objects of a bundle adjustment: their parameters, their priors, and the constraints between
// objects and poses that the detections give.
class ObjectBundle final : public ceres::IterationCallback {
 public:
  ObjectBundle(const Map& map, const PinholeCamera& camera, const BundleWindow& window,
               const PoseIndices& pose_indices, const ObjectBundleOptions& options);

  // The number of costs: a prior per object, and the silhouette and depth points per detection.
  size_t CountCosts() const;
  // `poses` are those of the window's keyframes, the moving ones before the fixed ones. They and
  // this object must outlive the problem.
  void AddResiduals(ceres::Problem& problem, std::vector<PoseBlock>& poses);
  // Puts the half axes of the objects into group 0 of the ordering, their poses into group 2.
  void AddParameters(ceres::Problem& problem, PoseManifold& manifold,
                     ceres::ParameterBlockOrdering& ordering);
  // Whether there is an object that is not locked. The locked ones are constant.
  bool HasMoving() const;

  // Whether an observation was undefined at the last evaluation. A quadric that reaches the plane
  // of a camera has no projected ellipse there, so Ceres rejects the step. One object beside one
  // camera would then hold the whole map, so such an observation has to be left out.
  bool HasUndefinedObservation() const;
  // Ends the solution when there is such an observation.
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& /*summary*/) override {
    return HasUndefinedObservation() ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                                     : ceres::SOLVER_CONTINUE;
  }
  // Leaves the undefined observations out. Returns whether there were any.
  bool LeaveOutUndefinedObservations();

  // Writes the quadrics. An object fails if it is behind a camera whose observation was left out.
  void Write(const std::vector<PoseBlock>& poses, BundleResult& result) const;

 private:
  struct Object {
    ObjectId id;
    Ellipsoid before;
    PoseBlock pose{};  // world_from_object
    Eigen::Vector3d log_axes = Eigen::Vector3d::Zero();
    bool is_fixed = false;   // ObjectLandmark::IsFixed
    bool has_depth = false;  // whether an observation has depth points on it
    // The prior and the observations from keyframes that do not move.
    std::unique_ptr<ObjectSumCost> fixed_part;
  };
  // The silhouette and the depth points of one detection in a moving keyframe.
  struct Observation {
    size_t object = 0;
    size_t pose = 0;  // index into the window's poses
    std::unique_ptr<ObjectSumCost> cost;
  };

  bool IsDefinedEverywhere(size_t object, const std::vector<PoseBlock>& poses) const;
  void AddObject(const Map& map, ObjectId id, const PoseIndices& pose_indices);
  // `pose` is the index of a moving pose of the window, or null.
  void AddView(const Map& map, const ObjectObservation& seen, double misfit_px, const size_t* pose);

  PinholeCamera camera_;
  ObjectBundleOptions options_;
  size_t moving_poses_;
  std::vector<Object> objects_;
  std::vector<Observation> observations_;
};

}  // namespace hullslam::internal
