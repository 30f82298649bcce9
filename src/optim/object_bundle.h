// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/ordered_groups.h>
#include <ceres/problem.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "costs/pose_manifold.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/map/map.h"
#include "optim/bundle_adjustment.h"
#include "util/id_map.h"

namespace hullslam::internal {

// The places of the keyframes of a window among its poses: the moving ones come before the fixed
// ones.
using PoseIndices = IdMap<KeyframeId, size_t>;
PoseIndices IndexPoses(const BundleWindow& window);

// The objects of a bundle adjustment: their parameters, their priors, and the constraints between
// them and the poses that their detections give.
class ObjectBundle {
 public:
  ObjectBundle(const Map& map, const PinholeCamera& camera, const BundleWindow& window,
               const PoseIndices& pose_indices, const ObjectBundleOptions& options);

  // `poses` are those of the window's keyframes, the moving ones before the fixed ones. They and
  // this object must outlive the problem.
  void AddResiduals(ceres::Problem& problem, std::vector<PoseBlock>& poses);
  // Puts the half axes of the objects into `axes_group` of the ordering, their poses into group 2
  // and the poses outside of the window into group 3.
  void AddParameters(ceres::Problem& problem, PoseManifold& manifold, int axes_group,
                     ceres::ParameterBlockOrdering& ordering);
  void Write(BundleResult& result) const;

 private:
  struct Object {
    ObjectId id;
    Ellipsoid before;
    PoseBlock pose{};  // world_from_object
    Eigen::Vector3d log_axes = Eigen::Vector3d::Zero();
    bool has_depth = false;  // whether a view has depth points on it
    std::unique_ptr<ceres::CostFunction> prior;
  };
  // The residuals of one detection: those of its outline or those of its depth points.
  struct Term {
    size_t object = 0;
    size_t pose = 0;  // index into the window's poses followed by outer_poses_
    std::unique_ptr<ceres::CostFunction> cost;
  };

  void AddObject(const Map& map, ObjectId id, const PoseIndices& pose_indices);
  // `pose` is an index as in Term.
  void AddView(const Map& map, const ObjectObservation& seen, double misfit_px, size_t pose);
  void AddTerm(const Rigid3& cam_from_world, size_t pose,
               std::unique_ptr<ceres::CostFunction> cost);

  PinholeCamera camera_;
  ObjectBundleOptions options_;
  std::vector<Object> objects_;
  std::vector<Term> terms_;
  size_t window_poses_ = 0;
  std::vector<PoseBlock> outer_poses_;  // of keyframes outside of the window
};

}  // namespace hullslam::internal
