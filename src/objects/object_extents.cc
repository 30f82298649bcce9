// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/object_extents.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/rotation.h>
#include <ceres/solver.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "objects/constraint/misfit.h"
#include "objects/resolved_observation.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

constexpr size_t kMinPlanes = 30;    // for nine unknowns; neighbouring planes are nearly equal
constexpr double kLossScale = 0.04;  // share of the largest half axis
constexpr double kBorderPx = 20.0;   // lines that touch the mask nearer to the border are left out
constexpr double kMaxMisfit = 0.1;   // share of the longest side
constexpr int kIterations = 50;
constexpr double kMaxLogHalf =
    100.0;  // largest logarithm of a half side; its exponential is still finite

enum class Body { kBox, kEllipsoid };

// The signed distance of a tangent plane from a body: the support function of the object minus that
// of the body. Parameters: logarithms of the half sides, offset of the centre and rotation vector,
// both in the frame of the quadric.
class PlaneCost {
 public:
  PlaneCost(Body body, const Eigen::Vector3d& normal, double support)
      : body_(body), normal_(normal), support_(support) {}

  template <typename T>
  bool operator()(const T* log_half, const T* offset, const T* rotation, T* residual) const {
    const std::array<T, 3> normal = {T(normal_.x()), T(normal_.y()), T(normal_.z())};
    const std::array<T, 3> back = {-rotation[0], -rotation[1], -rotation[2]};
    std::array<T, 3> in_body;
    ceres::AngleAxisRotatePoint(back.data(), normal.data(), in_body.data());
    T sum(0.0);
    T moved(0.0);
    for (size_t i = 0; i < 3; ++i) {
      if (log_half[i] > T(kMaxLogHalf)) {
        return false;  // the solver tries a shorter step
      }
      const T reach = ceres::exp(log_half[i]) * in_body[i];
      sum += body_ == Body::kBox ? ceres::abs(reach) : reach * reach;
      moved += offset[i] * normal[i];
    }
    residual[0] = (body_ == Body::kBox ? sum : ceres::sqrt(sum)) + moved - T(support_);
    return true;
  }

 private:
  Body body_;
  Eigen::Vector3d normal_;
  double support_;
};

// A plane that touches the object, in the frame of the quadric.
struct TouchingPlane {
  Eigen::Vector3d normal;  // outwards
  double support = 0.0;    // distance from the centre of the quadric
};

// Whether the hull's corner that the line touches is near the border of the image.
bool IsNearBorder(const Detection& detection, const Line2& line, const Sensor& sensor) {
  const auto corner = std::max_element(
      detection.hull.begin(), detection.hull.end(),
      [&](const auto& a, const auto& b) { return line.normal.dot(a) < line.normal.dot(b); });
  if (corner == detection.hull.end()) {
    return true;
  }
  const PinholeCamera::Bounds bounds = sensor.camera.RawBounds();
  const Eigen::Vector2d pixel = sensor.camera.Distort(*corner);
  return std::min({pixel.x() - bounds.min_x, bounds.max_x - pixel.x(), pixel.y() - bounds.min_y,
                   bounds.max_y - pixel.y()}) < kBorderPx;
}

std::vector<TouchingPlane> FindPlanes(const Sensor& sensor, const Ellipsoid& ellipsoid,
                                      std::span<const ResolvedObservation> observations) {
  std::vector<TouchingPlane> planes;
  for (const ResolvedObservation& observation : observations) {
    for (const SilhouetteLine& line : observation.detection->lines) {
      if (line.is_one_sided || IsNearBorder(*observation.detection, line.line, sensor)) {
        continue;
      }
      if (const auto plane =
              PlaneOfLine(sensor.camera, observation.cam_from_world, ellipsoid, line.line)) {
        const double quadric = ellipsoid.half_axes.cwiseProduct(plane->normal).norm();
        planes.push_back({plane->normal, plane->excess + quadric});
      }
    }
  }
  return planes;
}

struct Fit {
  Eigen::Vector3d half_sides;
  double cost = 0.0;  // sum of the squared distances, with the loss
  double rms = 0.0;   // RMS of the distances, without the loss
};

std::optional<Fit> FitBody(Body body, std::span<const TouchingPlane> planes,
                           const Eigen::Vector3d& axes) {
  Eigen::Vector3d log_half = axes.array().log();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
  ceres::HuberLoss loss(kLossScale * axes.maxCoeff());
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  for (const TouchingPlane& plane : planes) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PlaneCost, 1, 3, 3, 3>(
                                 new PlaneCost(body, plane.normal, plane.support)),
                             &loss, log_half.data(), offset.data(), rotation.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = kIterations;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable() || !log_half.allFinite()) {
    return std::nullopt;
  }
  ceres::Problem::EvaluateOptions without_loss;
  without_loss.apply_loss_function = false;
  double half_squares = 0.0;
  problem.Evaluate(without_loss, &half_squares, nullptr, nullptr, nullptr);
  const auto count = static_cast<double>(planes.size());
  return Fit{log_half.array().exp(), summary.final_cost, std::sqrt(2.0 * half_squares / count)};
}

}  // namespace

std::optional<ObjectExtents> MeasureExtents(const Sensor& sensor, const Ellipsoid& ellipsoid,
                                            std::span<const ResolvedObservation> observations) {
  const std::vector<TouchingPlane> planes = FindPlanes(sensor, ellipsoid, observations);
  if (planes.size() < kMinPlanes) {
    return std::nullopt;
  }
  std::optional<Fit> best;
  for (const Body body : {Body::kBox, Body::kEllipsoid}) {
    const std::optional<Fit> fit = FitBody(body, planes, ellipsoid.half_axes);
    if (fit && (!best || fit->cost < best->cost)) {
      best = fit;
    }
  }
  if (!best) {
    return std::nullopt;
  }
  ObjectExtents extents;
  extents.sides = 2.0 * best->half_sides;
  std::sort(extents.sides.begin(), extents.sides.end());
  extents.misfit = best->rms / extents.sides.z();
  return extents.misfit <= kMaxMisfit ? std::optional(extents) : std::nullopt;
}

double KnownSize(const ObjectLandmark& object, const std::map<std::string, double>& sizes) {
  if (object.state != ObjectState::kMapped) {
    return 0.0;
  }
  if (object.known_size > 0.0 || sizes.empty()) {
    return object.known_size;
  }
  const auto size = sizes.find(object.Label());
  return size != sizes.end() ? size->second : 0.0;
}

KnownScale MeasureScale(const Map& map, const Sensor& sensor,
                        const std::map<std::string, double>& sizes) {
  std::vector<double> scales;  // one per observation
  size_t objects = 0;
  map.objects().ForEach([&](ObjectId, const ObjectLandmark& object) {
    const double size = KnownSize(object, sizes);
    if (size <= 0.0) {
      return;
    }
    if (const auto extents =
            MeasureExtents(sensor, object.ellipsoid, ResolveObservations(map, object))) {
      scales.insert(scales.end(), object.observations.size(), size / extents->sides.z());
      ++objects;
    }
  });
  if (scales.empty()) {
    return {};
  }
  return {.objects = objects, .metres_per_unit = Median(std::move(scales))};
}

}  // namespace hullslam
