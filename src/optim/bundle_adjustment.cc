// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/bundle_adjustment.h"

#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "costs/pose_manifold.h"
#include "costs/reprojection.h"
#include "costs/reprojection_rgbd.h"
#include "frame/point_measurement.h"
#include "map/landmark_edits.h"
#include "optim/object_bundle.h"
#include "util/chi_square.h"

namespace hullslam {
namespace {

// Up to this number, nearly all poses share points, so the reduced system is nearly full and a
// dense solver is faster. CHOLMOD would also start threads, which take time from the tracker's
// core.
constexpr size_t kMaxDensePoses = 60;

constexpr size_t kNoPose = std::numeric_limits<size_t>::max();

struct BundleObservation {
  LandmarkId landmark;
  KeyframeId keyframe;
  size_t point_index = 0;
  size_t pose_index = 0;
  double bound = 0.0;  // chi-square
  std::unique_ptr<ceres::CostFunction> cost;
  bool is_inlier = true;
};

class StopOnRequest final : public ceres::IterationCallback {
 public:
  explicit StopOnRequest(const Cancellation* cancellation) : cancellation_(cancellation) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return cancellation_ != nullptr && cancellation_->IsRequested()
               ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
               : ceres::SOLVER_CONTINUE;
  }

 private:
  const Cancellation* cancellation_;
};

std::unique_ptr<ceres::CostFunction> MakeCost(const PinholeCamera& camera,
                                              const PointMeasurement& measurement) {
  if (measurement.has_depth()) {
    return std::make_unique<RgbdReprojectionCost>(camera, measurement);
  }
  return std::make_unique<ReprojectionCost>(camera, measurement);
}

// The parameter blocks and the observations that connect them.
class Bundle {
 public:
  Bundle(const Map& map, const Sensor& sensor, const BundleWindow& window,
         const ObjectBundleOptions& options)
      : window_(window), keyframes_(window.moving), objects_(map, sensor.camera, window, options) {
    keyframes_.insert(keyframes_.end(), window.fixed.begin(), window.fixed.end());
    index_of_pose_.assign(map.keyframes().NextId().value, kNoPose);
    for (const KeyframeId id : keyframes_) {
      index_of_pose_[id.value] = poses_.size();
      poses_.push_back(ToBlock(map.keyframes().At(id).cam_from_world));
    }
    for (size_t i = 0; i < window.landmarks.size(); ++i) {
      points_.push_back(map.landmarks().At(window.landmarks[i]).position);
      AddObservations(map, sensor, i);
    }
  }

  bool Solve(const BundleOptions& options, int iterations, bool robust,
             const Cancellation* cancellation, BundleResult& result) {
    ceres::Problem problem(ProblemOptions());
    ceres::Solver::Options solver;
    solver.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    AddResiduals(problem, robust);
    objects_.AddResiduals(problem, poses_);
    AddParameters(problem, *solver.linear_solver_ordering);
    objects_.AddParameters(problem, manifold_, *solver.linear_solver_ordering);
    solver.linear_solver_type =
        window_.moving.size() <= kMaxDensePoses ? ceres::DENSE_SCHUR : ceres::SPARSE_SCHUR;
    solver.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
    solver.max_num_iterations = iterations;
    solver.function_tolerance = options.function_tolerance;
    solver.num_threads = options.threads;
    solver.logging_type = ceres::SILENT;
    StopOnRequest stop(cancellation);
    solver.callbacks.push_back(&stop);
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    result.residuals = problem.NumResidualBlocks();
    result.iterations += static_cast<int>(summary.iterations.size());
    return summary.IsSolutionUsable();
  }

  // Leaves out observations without a residual at the start: their points are not in front of the
  // camera.
  void ExcludeUndefined() {
    for (BundleObservation& observation : observations_) {
      observation.is_inlier = Chi2(observation) < std::numeric_limits<double>::infinity();
    }
  }

  // Decides again which observations are inliers.
  void Classify() {
    for (BundleObservation& observation : observations_) {
      observation.is_inlier = Chi2(observation) <= observation.bound;
    }
  }

  void Write(BundleResult& result) const {
    for (size_t i = 0; i < window_.moving.size(); ++i) {
      result.poses.emplace_back(window_.moving[i], FromBlock(poses_[i].data()));
    }
    for (size_t i = 0; i < points_.size(); ++i) {
      result.positions.emplace_back(window_.landmarks[i], points_[i]);
    }
    for (const BundleObservation& observation : observations_) {
      if (!observation.is_inlier) {
        result.outliers.emplace_back(observation.landmark, observation.keyframe);
      }
    }
    objects_.Write(result);
  }

 private:
  static ceres::Problem::Options ProblemOptions() {
    ceres::Problem::Options options;
    options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.disable_all_safety_checks = true;
    return options;
  }

  double Chi2(const BundleObservation& observation) const {
    const double* parameters[] = {poses_[observation.pose_index].data(),
                                  points_[observation.point_index].data()};
    Eigen::Vector3d residual = Eigen::Vector3d::Zero();
    const bool is_defined = observation.cost->Evaluate(parameters, residual.data(), nullptr);
    return is_defined ? residual.squaredNorm() : std::numeric_limits<double>::infinity();
  }

  void AddObservations(const Map& map, const Sensor& sensor, size_t point_index) {
    const LandmarkId landmark = window_.landmarks[point_index];
    for (const Observation& seen : map.landmarks().At(landmark).observations) {
      const size_t pose_index = index_of_pose_[seen.keyframe.value];
      if (pose_index == kNoPose) {
        continue;
      }
      const PointMeasurement measurement =
          MeasurePoint(sensor, map.keyframes().At(seen.keyframe).frame->features, seen.keypoint,
                       sensor.depth_error.ForAdjustment());
      BundleObservation& observation = observations_.emplace_back();
      observation.landmark = landmark;
      observation.keyframe = seen.keyframe;
      observation.point_index = point_index;
      observation.pose_index = pose_index;
      observation.bound = OutlierBound(measurement);
      observation.cost = MakeCost(sensor.camera, measurement);
    }
  }

  void AddResiduals(ceres::Problem& problem, bool robust) {
    for (BundleObservation& observation : observations_) {
      if (observation.is_inlier) {
        ceres::LossFunction* loss =
            observation.cost->num_residuals() == 3 ? &huber_with_depth_ : &huber_without_depth_;
        problem.AddResidualBlock(observation.cost.get(), robust ? loss : nullptr,
                                 poses_[observation.pose_index].data(),
                                 points_[observation.point_index].data());
      }
    }
  }

  void AddParameters(ceres::Problem& problem, ceres::ParameterBlockOrdering& ordering) {
    for (Eigen::Vector3d& point : points_) {
      if (problem.HasParameterBlock(point.data())) {
        ordering.AddElementToGroup(point.data(), 0);
      }
    }
    for (size_t i = 0; i < poses_.size(); ++i) {
      double* pose = poses_[i].data();
      if (!problem.HasParameterBlock(pose)) {
        continue;
      }
      problem.SetManifold(pose, &manifold_);
      if (i >= window_.moving.size()) {
        problem.SetParameterBlockConstant(pose);
      }
      ordering.AddElementToGroup(pose, 1);
    }
  }

  const BundleWindow& window_;
  std::vector<KeyframeId> keyframes_;  // the moving ones, then the fixed ones
  std::vector<PoseBlock> poses_;
  std::vector<size_t> index_of_pose_;  // by keyframe id; kNoPose outside the window
  std::vector<Eigen::Vector3d> points_;
  std::vector<BundleObservation> observations_;
  internal::ObjectBundle objects_;
  PoseManifold manifold_;
  ceres::HuberLoss huber_without_depth_{std::sqrt(Chi2Bound(2))};
  ceres::HuberLoss huber_with_depth_{std::sqrt(Chi2Bound(3))};
};

BundleResult Adjust(const Map& map, const Sensor& sensor, const BundleWindow& window,
                    const BundleOptions& options, const Cancellation* cancellation) {
  BundleResult result;
  Bundle bundle(map, sensor, window, options.objects);
  bundle.ExcludeUndefined();
  if (!bundle.Solve(options, options.robust_iterations, true, cancellation, result)) {
    return result;
  }
  // After a cancelled round the errors are not minimal, so they do not tell which are outliers.
  if (cancellation == nullptr || !cancellation->IsRequested()) {
    bundle.Classify();
    if (!bundle.Solve(options, options.final_iterations, false, cancellation, result)) {
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
                          const BundleOptions& options, const Cancellation* cancellation) {
  BundleResult result = Adjust(map, sensor, window, options, cancellation);
  if (result.is_usable || window.objects.empty()) {
    return result;
  }
  BundleWindow points_only = window;
  points_only.objects.clear();
  result = Adjust(map, sensor, points_only, options, cancellation);
  result.failed_objects = window.objects;
  return result;
}

void ApplyBundle(Map& map, const BundleResult& result, const ScaleLevels& levels) {
  for (const auto& [landmark, keyframe] : result.outliers) {
    const Landmark* seen = map.landmarks().Find(landmark);
    if (seen == nullptr) {
      continue;
    }
    const bool observed =
        std::any_of(seen->observations.begin(), seen->observations.end(),
                    [id = keyframe](const Observation& o) { return o.keyframe == id; });
    if (observed) {
      map.RemoveObservation(landmark, keyframe);
    }
  }
  for (const auto& [keyframe, pose] : result.poses) {
    if (map.keyframes().Contains(keyframe)) {
      map.SetPose(keyframe, pose);
    }
  }
  for (const auto& [landmark, position] : result.positions) {
    if (map.landmarks().Contains(landmark)) {
      map.SetPosition(landmark, position);
      UpdateViewingGeometry(map, landmark, levels);
    }
  }
  for (const auto& [object, ellipsoid] : result.ellipsoids) {
    if (map.objects().Contains(object)) {
      map.MutableObject(object).ellipsoid = ellipsoid;
    }
  }
}

}  // namespace hullslam
