// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/bundle_adjustment.h"

#include <ceres/problem.h>
#include <ceres/solver.h>
#include <malloc.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "costs/manifolds.h"
#include "frame/measure_point.h"
#include "optim/bundle_options.h"
#include "optim/bundle_points.h"
#include "optim/eliminated_points.h"
#include "optim/keypoint_weights.h"
#include "optim/object_bundle.h"
#include "optim/reduced_points_cost.h"
#include "optim/robust.h"
#include "optim/supervision.h"

namespace hullslam {
namespace {

using internal::Supervision;

// The parameters of a bundle adjustment and the residuals between them.
class Bundle {
 public:
  Bundle(const Map& map, const Sensor& sensor, const BundleWindow& window,
         const BundleOptions& options)
      : camera_(sensor.camera),
        window_(window),
        options_(options),
        pose_indices_(internal::IndexPoses(window)),
        objects_(map, sensor.camera, window, pose_indices_, options.objects) {
    std::vector<std::vector<double>> weights;  // of the keypoints of each pose; monocular only
    for (const auto& [id, index] : pose_indices_.entries()) {
      const Keyframe& keyframe = map.keyframes().At(id);
      poses_.push_back(ToBlock(keyframe.cam_from_world));
      if (BundleRules::ForSensor(sensor).keypoints_share_weights) {
        weights.push_back(internal::KeypointWeights(keyframe, sensor.levels));
      }
    }
    size_t observations = 0;
    for (const LandmarkId id : window.landmarks) {
      observations += map.landmarks().At(id).observations.size();
    }
    points_.Reserve(window.landmarks.size(), observations);
    for (const LandmarkId id : window.landmarks) {
      AddPoint(map, sensor, map.landmarks().At(id), weights);
    }
  }

  // Leaves out observations without a residual at the start: of points behind the camera.
  void ExcludeUndefined() {
    ForEachObservation([](PointObservation& observation, double chi2, size_t) {
      observation.is_inlier = std::isfinite(chi2);
    });
  }

  // Makes the standard deviations of the keypoints as small as the errors show them to be
  // (MeasureKeypointPrecision).
  void MeasurePrecision() {
    std::vector<double> errors;
    ForEachObservation([&](const PointObservation& observation, double chi2, size_t) {
      if (observation.is_inlier) {
        errors.push_back(chi2);
      }
    });
    const double precision =
        internal::MeasureKeypointPrecision(std::move(errors), points_.size(), precision_);
    if (precision != precision_) {
      ForEachObservation([&](PointObservation& observation, double, size_t) {
        observation.measurement.inverse_sigma *= precision / precision_;
      });
      precision_ = precision;
    }
  }

  // Decides again which observations are inliers.
  void Classify() {
    const double factor = internal::OutlierBoundFactor(precision_);
    ForEachObservation([factor](PointObservation& observation, double chi2, size_t) {
      observation.is_inlier = chi2 <= factor * OutlierBound(observation.measurement);
    });
  }

  // Our own code eliminates the points, and Ceres solves for the poses and the objects.
  bool Solve(int iterations, PointLoss loss, Supervision& supervision, BundleResult& result) {
    const bool is_sparse = window_.moving.size() > options_.max_dense;
    internal::FollowOptions follow = options_.follow;
    if (is_sparse) {  // in a large map there is always a point that a step moves behind a camera
      follow.chi2_behind = 3e4;  // 100 sigmas in each residual
    }
    internal::EliminatedPoints eliminated(camera_, points_, window_.moving.size(), loss, follow);
    internal::ReducedPointsCost cost(eliminated, poses_, is_sparse);
    for (int i = 0; window_.moving.empty() && i < iterations; ++i) {
      cost.PrepareForEvaluation(false, true);  // moves the points
      eliminated.Accept();
    }
    ceres::Problem::Options problem_options;
    problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    problem_options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    problem_options.disable_all_safety_checks = true;
    problem_options.evaluation_callback = &cost;
    ceres::Problem problem(problem_options);
    cost.AddResiduals(problem);
    objects_.AddResiduals(problem, poses_);
    ceres::Solver::Options solver;
    solver.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (size_t i = 0; i < window_.moving.size(); ++i) {
      problem.SetManifold(poses_[i].data(), &manifold_);
      solver.linear_solver_ordering->AddElementToGroup(poses_[i].data(), 1);
    }
    objects_.AddParameters(problem, manifold_, *solver.linear_solver_ordering);
    // If there are objects, Ceres eliminates their half axes.
    if (objects_.HasMoving()) {
      solver.linear_solver_type = is_sparse ? ceres::SPARSE_SCHUR : ceres::DENSE_SCHUR;
    } else {
      solver.linear_solver_type =
          is_sparse ? ceres::SPARSE_NORMAL_CHOLESKY : ceres::DENSE_NORMAL_CHOLESKY;
    }
    solver.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
    solver.max_num_iterations = iterations;
    solver.function_tolerance = options_.function_tolerance;
    solver.num_threads = options_.threads;
    solver.logging_type = ceres::SILENT;
    solver.callbacks = {&supervision, &objects_};
    ceres::Solver::Summary summary;
    do {
      ceres::Solve(solver, &problem, &summary);
      const int evaluations = static_cast<int>(summary.iterations.size());  // with the start
      result.iterations += evaluations;
      solver.max_num_iterations -= evaluations - 1;
    } while (summary.IsSolutionUsable() && solver.max_num_iterations > 0 &&
             objects_.LeaveOutUndefinedObservations());
    result.residuals = points_.CountInliers() + static_cast<int>(objects_.CountCosts());
    if (!summary.IsSolutionUsable()) {
      spdlog::debug("bundle adjustment of {} keyframes, {} landmarks and {} objects failed: {}",
                    window_.moving.size(), points_.positions().size(), window_.objects.size(),
                    summary.message);
    }
    return summary.IsSolutionUsable();
  }

  void Write(BundleResult& result) {
    for (size_t i = 0; i < window_.moving.size(); ++i) {
      result.poses.emplace_back(window_.moving[i], FromBlock(poses_[i].data()));
    }
    std::ranges::sort(result.poses, {}, &std::pair<KeyframeId, Rigid3>::first);
    for (size_t i = 0; i < points_.size(); ++i) {
      result.positions.emplace_back(window_.landmarks[i], points_.positions()[i]);
    }
    ForEachObservation([&](const PointObservation& observation, double, size_t point) {
      if (!observation.is_inlier) {
        result.outliers.emplace_back(window_.landmarks[point],
                                     pose_indices_.entries()[observation.pose].first);
      }
    });
    objects_.Write(poses_, result);
  }

 private:
  using PointObservation = internal::BundlePoints::PointObservation;

  void AddPoint(const Map& map, const Sensor& sensor, const Landmark& landmark,
                const std::vector<std::vector<double>>& weights) {
    points_.AddPoint(landmark.position);
    for (const Observation& seen : landmark.observations) {
      if (const size_t* const pose = pose_indices_.Find(seen.keyframe)) {
        const Keyframe& keyframe = map.keyframes().At(seen.keyframe);
        const double weight = weights.empty() ? 1.0 : weights[*pose][seen.keypoint];
        points_.AddView(MeasurePoint(sensor, keyframe.frame->features, seen.keypoint,
                                     sensor.depth_error.ForAdjustment()),
                        *pose, weight);
      }
    }
  }

  // Calls visit(observation, its PointChi2, index of its point).
  template <typename Visitor>
  void ForEachObservation(Visitor&& visit) {
    std::vector<Rigid3> cam_from_world;
    for (const PoseBlock& pose : poses_) {
      cam_from_world.push_back(FromBlock(pose.data()));
    }
    for (size_t i = 0; i < points_.size(); ++i) {
      for (PointObservation& observation : points_.ObservationsOf(i)) {
        const Eigen::Vector3d in_camera = cam_from_world[observation.pose] * points_.positions()[i];
        visit(observation, PointChi2(camera_, observation.measurement, in_camera), i);
      }
    }
  }

  const PinholeCamera& camera_;
  const BundleWindow& window_;
  const BundleOptions& options_;
  const internal::PoseIndices pose_indices_;
  std::vector<PoseBlock> poses_;
  internal::BundlePoints points_;
  double precision_ = 1.0;  // precision of the keypoints (MeasureKeypointPrecision)
  internal::ObjectBundle objects_;
  PoseManifold manifold_;
};

BundleResult Adjust(const Map& map, const Sensor& sensor, BundleWindow window,
                    const BundleOptions& options, Supervision& supervision) {
  BundleResult result;
  if (window.moving.size() > options.max_dense) {
    SortForElimination(map, window);
  }
  Bundle bundle(map, sensor, window, options);
  bundle.ExcludeUndefined();
  const BundleRules rules = BundleRules::ForSensor(sensor);
  if (rules.precision_is_measured) {
    bundle.MeasurePrecision();
  }
  if (!bundle.Solve(options.robust_iterations, rules.robust_loss, supervision, result)) {
    return result;
  }
  // After a cancelled round the errors are not minimal, so outliers cannot be recognised.
  if (!supervision.IsCancelled()) {
    if (rules.precision_is_measured) {
      bundle.MeasurePrecision();
    }
    bundle.Classify();
    if (!bundle.Solve(options.final_iterations, rules.final_loss, supervision, result)) {
      return result;
    }
    bundle.Classify();
  }
  bundle.Write(result);
  result.is_usable = true;
  return result;
}

}  // namespace

BundleResult AdjustBundle(const Map& map, const Sensor& sensor, const BundleWindow& window,
                          const BundleOptions& given, const Cancellation* cancellation,
                          const ProgressCallback& on_progress) {
  const BundleRules rules = BundleRules::ForSensor(sensor);
  const BundleOptions options = rules.is_solved_precisely ? given.ForMonocular() : given;
  const int most = options.robust_iterations + options.final_iterations;
  Supervision supervision(cancellation, on_progress, most);
  // Locked objects are constant, so they hold the scale.
  bool is_scale_free = std::ranges::none_of(
      window.objects, [&](ObjectId id) { return map.objects().At(id).IsFixed(); });
  BundleResult result = Adjust(map, sensor, window, options, supervision);
  if (!result.is_usable && !window.objects.empty()) {
    BundleWindow points_only = window;
    points_only.objects.clear();
    Supervision again(cancellation, on_progress, most);
    result = Adjust(map, sensor, points_only, options, again);
    result.failed_objects = window.objects;
    is_scale_free = true;
  }
  if (rules.keeps_scale && is_scale_free && result.is_usable && window.fixed.size() == 1) {
    KeepScale(map, window.fixed.front(), result);
  }
  return result;
}

IslandAdjustment AdjustIsland(const Map& map, IslandId island, const Sensor& sensor,
                              const ObjectOptions& options, const Cancellation* cancellation,
                              const ProgressCallback& on_progress) {
  malloc_trim(0);  // gives pages that nothing is in back, because this needs much memory
  BundleWindow window = GlobalWindow(map, island, ObjectsToAdjust(options));
  BundleResult result =
      AdjustBundle(map, sensor, window, BundleOptions{.objects = options.bundle}.ForWholeMap(),
                   cancellation, on_progress);
  malloc_trim(0);
  return {.result = std::move(result), .objects = std::move(window.objects)};
}

}  // namespace hullslam
