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

namespace hullslam::internal {

// The part of a bundle adjustment that the window's objects are: their parameters and what their
// detections say of them and of the poses.
class ObjectBundle {
 public:
  ObjectBundle(const Map& map, const PinholeCamera& camera, const BundleWindow& window,
               const ObjectBundleOptions& options);

  // `poses` are those of the window's keyframes, the moving ones before the fixed ones. They and
  // this must outlive the problem.
  void AddResiduals(ceres::Problem& problem, std::vector<PoseBlock>& poses);
  // Puts the objects into group 2 of the ordering, poses outside of the window into group 3.
  void AddParameters(ceres::Problem& problem, PoseManifold& manifold,
                     ceres::ParameterBlockOrdering& ordering);
  void Write(BundleResult& result) const;

 private:
  struct Object {
    ObjectId id;
    Ellipsoid before;
    PoseBlock pose{};  // world_from_object
    Eigen::Vector3d log_axes = Eigen::Vector3d::Zero();
    bool has_depth = false;  // whether depth points hold it
    std::unique_ptr<ceres::CostFunction> prior;
  };
  // One term of a detection: its outline or its depth points.
  struct Term {
    size_t object = 0;
    size_t pose = 0;  // index into the window's poses, or that much beyond into outer_poses_
    std::unique_ptr<ceres::CostFunction> cost;
  };

  void AddObject(const Map& map, ObjectId id, const std::vector<KeyframeId>& keyframes);
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
