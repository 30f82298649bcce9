// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/camera_problem.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "optim/robust.h"
#include "util/statistics.h"
#include "util/task_runner.h"

namespace hullslam {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kFixed = 1e9;  // weight of what does not move, relative to the largest

// Steps must be good to second order where a part of the map turns against another, since that
// hardly changes the cost: otherwise only tiny ones are possible. So a view moves along a screw,
// which is exact for a turn of everything around it.
Rigid3 ViewAfterStep(const Rigid3& cam_from_world, const Eigen::Matrix<double, 6, 1>& step) {
  const Eigen::Vector3d turn = step.head<3>();
  const Eigen::Vector3d shift = step.tail<3>();
  const Eigen::Vector3d first = turn.cross(shift);
  return Rigid3(ExpSo3(turn), shift + first / 2.0 + turn.cross(first) / 6.0) * cam_from_world;
}

// And a point moves with the first view that sees it, in whose coordinates (x / z, y / z, 1 / z)
// also far points move evenly (Civera, Davison and Montiel 2008). `step` is that in the world.
Eigen::Vector3d PointAfterStep(const Rigid3& before, const Eigen::Matrix<double, 6, 1>& view_step,
                               const Rigid3& after, const Eigen::Vector3d& point,
                               const Eigen::Vector3d& step) {
  constexpr double kLeast = 0.1;  // of 1 / z, in one step
  const Eigen::Vector3d p = before * point;
  const Eigen::Vector3d change =
      before.rotation * step + view_step.head<3>().cross(p) + view_step.tail<3>();
  const double inverse = std::max(1.0 - change.z() / p.z(), kLeast) / p.z();
  const Eigen::Vector2d on_plane =
      (p.head<2>() + change.head<2>() - p.head<2>() * (change.z() / p.z())) / p.z();
  return Inverse(after) * (on_plane.homogeneous() / inverse).eval();
}

}  // namespace

// A point with the second derivatives of the cost by it and by what it is seen with.
struct CameraAdjustment::PointSystem {
  struct Coupling {
    Eigen::Index row = 0;  // of the view's parameters
    Eigen::Matrix<double, 6, 3> block;
  };
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inverse;
  std::vector<Coupling> couplings;
  Eigen::Matrix<double, Eigen::Dynamic, 3> by_camera;
};

// What is the same for all points of a system.
struct CameraAdjustment::Reduction {
  const std::vector<uint8_t>& is_left_out;
  ByCameraParameters by_camera;
};

size_t CalibrationProblem::CountObservations() const {
  size_t count = 0;
  for (const std::vector<CalibrationObservation>& seen : observations) {
    count += seen.size();
  }
  return count;
}

void CalibrationProblem::Append(const CalibrationProblem& other) {
  const auto first = static_cast<uint32_t>(views.size());
  const uint32_t recording = views.empty() ? 0 : views.back().recording + 1;
  for (CalibrationView view : other.views) {
    view.recording += recording;
    views.push_back(view);
  }
  points.insert(points.end(), other.points.begin(), other.points.end());
  for (std::vector<CalibrationObservation> seen : other.observations) {
    for (CalibrationObservation& one : seen) {
      one.view += first;
    }
    observations.push_back(std::move(seen));
  }
  has_depth = other.has_depth;
  disparity_sigma = other.disparity_sigma;
  known_depth_pose = other.known_depth_pose;
}

CameraAdjustment::CameraAdjustment(CalibrationProblem problem, CameraModel model,
                                   std::vector<CameraParameter> parameters)
    : problem_(std::move(problem)),
      residual_{.disparity_sigma = problem_.disparity_sigma,
                .known_depth_pose = problem_.known_depth_pose},
      model_(model),
      parameters_(std::move(parameters)),
      loss_scale_(kCauchyScale) {
  cost_ = Cost(model_, problem_.views, problem_.points);
}

double CameraAdjustment::Cost(const CameraModel& model, std::span<const CalibrationView> views,
                              std::span<const Eigen::Vector3d> points) const {
  double cost = 0.0;
  for (const CameraParameter& parameter : parameters_) {
    const double deviation = parameter.DeviationIn(model);
    cost += 0.5 * deviation * deviation;
  }
  for (size_t i = 0; i < points.size(); ++i) {
    for (const CalibrationObservation& seen : problem_.observations[i]) {
      const CalibrationView& view = views[seen.view];
      const double chi2 =
          residual_.At(model, view.velocity, seen, view.cam_from_world * points[i]).squaredNorm();
      cost += 0.5 * CauchyCost(chi2, loss_scale_);
    }
  }
  return cost;
}

CameraAdjustment::PointSystem CameraAdjustment::SystemOf(size_t point, const Reduction& reduction,
                                                         ReducedSystem& sum) const {
  const Eigen::Index camera = camera_row();
  const auto numbers = static_cast<Eigen::Index>(parameters_.size());
  PointSystem system;
  system.by_camera.setZero(numbers, 3);
  for (const CalibrationObservation& seen : problem_.observations[point]) {
    if (reduction.is_left_out[seen.view]) {
      continue;
    }
    const CalibrationView& view = problem_.views[seen.view];
    const Eigen::Vector3d in_camera = view.cam_from_world * problem_.points[point];
    const Eigen::Vector3d residual = residual_.At(model_, view.velocity, seen, in_camera);
    const double chi2 = residual.squaredNorm();
    if (!std::isfinite(chi2)) {
      continue;
    }
    const double weight = CauchyWeight(chi2, loss_scale_);
    const size_t rows = seen.disparity > 0.0 ? 3 : 2;
    sum.weighted_chi2 += weight * chi2;
    sum.weight += weight * static_cast<double>(rows);
    const Eigen::Matrix3d by_camera_point =
        residual_.ByPoint(model_, view.velocity, seen, in_camera);
    Eigen::Matrix<double, 3, 6> by_pose;
    by_pose << -by_camera_point * Skew(in_camera), by_camera_point;
    const Eigen::Matrix3d by_point =
        by_camera_point * view.cam_from_world.rotation.toRotationMatrix();
    const Eigen::Matrix<double, 3, Eigen::Dynamic> by_camera =
        reduction.by_camera.Of(residual_, view.velocity, seen, in_camera);
    const Eigen::Index row = 6 * static_cast<Eigen::Index>(seen.view);
    system.hessian.noalias() += weight * by_point.transpose() * by_point;
    system.gradient.noalias() += weight * by_point.transpose() * residual;
    system.couplings.push_back({row, weight * by_pose.transpose() * by_point});
    system.by_camera.noalias() += weight * by_camera.transpose() * by_point;
    sum.hessian.block<6, 6>(row, row).noalias() += weight * by_pose.transpose() * by_pose;
    sum.gradient.segment<6>(row).noalias() += weight * by_pose.transpose() * residual;
    sum.hessian.block(camera, row, numbers, 6).noalias() +=
        weight * by_camera.transpose() * by_pose;
    sum.hessian.block(camera, camera, numbers, numbers).noalias() +=
        weight * by_camera.transpose() * by_camera;
    sum.gradient.tail(numbers).noalias() += weight * by_camera.transpose() * residual;
  }
  return system;
}

// Adds a point to the sums, and takes it out of the unknown numbers.
CameraAdjustment::PointSystem CameraAdjustment::Eliminate(size_t index, const Reduction& reduction,
                                                          double damping,
                                                          ReducedSystem& sum) const {
  const Eigen::Index camera = camera_row();
  const auto numbers = static_cast<Eigen::Index>(parameters_.size());
  PointSystem point = SystemOf(index, reduction, sum);
  Eigen::Matrix3d damped = point.hessian;
  // A point in a single view without depth is not held along its ray.
  damped.diagonal() += damping * point.hessian.diagonal() +
                       Eigen::Vector3d::Constant(1e-12 * point.hessian.trace() + 1e-30);
  point.inverse = damped.inverse();
  const Eigen::Matrix<double, Eigen::Dynamic, 3> by_camera = point.by_camera * point.inverse;
  for (const PointSystem::Coupling& one : point.couplings) {
    const Eigen::Matrix<double, 6, 3> solved = one.block * point.inverse;
    sum.gradient.segment<6>(one.row).noalias() -= solved * point.gradient;
    for (const PointSystem::Coupling& other : point.couplings) {
      if (other.row <= one.row) {
        sum.hessian.block<6, 6>(one.row, other.row).noalias() -= solved * other.block.transpose();
      }
    }
    sum.hessian.block(camera, one.row, numbers, 6).noalias() -= by_camera * one.block.transpose();
  }
  sum.hessian.block(camera, camera, numbers, numbers).noalias() -=
      by_camera * point.by_camera.transpose();
  sum.gradient.tail(numbers).noalias() -= by_camera * point.gradient;
  return point;
}

ReducedSystem CameraAdjustment::Reduce(double damping, const std::vector<uint8_t>& is_left_out,
                                       std::vector<PointSystem>* points) const {
  const Eigen::Index camera = camera_row();
  const auto numbers = static_cast<Eigen::Index>(parameters_.size());
  const Reduction reduction{is_left_out, ByCameraParameters(model_, parameters_)};
  const size_t count = problem_.points.size();
  if (points != nullptr) {
    points->resize(count);
  }
  // As many parts on any computer, so that the sum has the same bits.
  std::array<ReducedSystem, 4> parts;
  ParallelRunner(0).Run(parts.size(), [&](size_t part) {
    ReducedSystem& sum = parts.at(part);
    sum.hessian.setZero(camera + numbers, camera + numbers);
    sum.gradient.setZero(camera + numbers);
    for (size_t i = part; i < count; i += parts.size()) {
      PointSystem point = Eliminate(i, reduction, damping, sum);
      if (points != nullptr) {
        (*points)[i] = std::move(point);
      }
    }
  });
  ReducedSystem& sum = parts.front();
  for (size_t part = 1; part < parts.size(); ++part) {
    sum.hessian += parts.at(part).hessian;
    sum.gradient += parts.at(part).gradient;
    sum.weighted_chi2 += parts.at(part).weighted_chi2;
    sum.weight += parts.at(part).weight;
  }
  for (size_t i = 0; i < parameters_.size(); ++i) {
    if (const double sigma = parameters_[i].prior_steps; sigma > 0.0) {
      const Eigen::Index row = camera + static_cast<Eigen::Index>(i);
      sum.hessian(row, row) += 1.0 / (sigma * sigma);
      sum.gradient[row] += parameters_[i].DeviationIn(model_) / sigma;
    }
  }
  FixFrame(is_left_out, sum.hessian);
  sum.hessian.diagonal() *= 1.0 + damping;
  return std::move(sum);
}

void CameraAdjustment::FixFrame(const std::vector<uint8_t>& is_left_out,
                                Eigen::MatrixXd& hessian) const {
  const double fixed = kFixed * (hessian.diagonal().cwiseAbs().maxCoeff() + 1.0);
  const std::vector<CalibrationView>& views = problem_.views;
  const auto center = [&](size_t view) { return Inverse(views[view].cam_from_world).translation; };
  const auto hold = [&](size_t view) {
    hessian.diagonal().segment<6>(6 * static_cast<Eigen::Index>(view)).array() += fixed;
  };
  for (size_t begin = 0; begin < views.size();) {
    std::optional<size_t> first;
    size_t farthest = begin;
    double most = 0.0;
    size_t i = begin;
    for (; i < views.size() && views[i].recording == views[begin].recording; ++i) {
      // Of a view that no point is left of, nothing is known.
      if (is_left_out[i] != 0 ||
          hessian(6 * static_cast<Eigen::Index>(i), 6 * static_cast<Eigen::Index>(i)) == 0.0) {
        hold(i);
      } else if (!first) {
        first = i;
        hold(i);
      } else if (const double distance = (center(i) - center(*first)).norm(); distance > most) {
        most = distance;
        farthest = i;
      }
    }
    if (!problem_.has_depth && most > 0.0) {
      // A step v of the translation of the view moves its centre by -R^T v.
      const Eigen::Vector3d direction = views[farthest].cam_from_world.rotation *
                                        (center(farthest) - center(*first)).normalized();
      const Eigen::Index row = 6 * static_cast<Eigen::Index>(farthest) + 3;
      hessian.block<3, 3>(row, row) += fixed * direction * direction.transpose();
    }
    begin = i;
  }
}

template <typename Measure>
double CameraAdjustment::MedianOf(const Measure& measure) const {
  std::vector<double> values;
  for (size_t i = 0; i < problem_.points.size(); ++i) {
    for (const CalibrationObservation& seen : problem_.observations[i]) {
      values.push_back(
          measure(seen, problem_.views[seen.view].cam_from_world * problem_.points[i]));
    }
  }
  return values.empty() ? 0.0 : Median(std::move(values));
}

Eigen::Vector3d CameraAdjustment::ResidualOf(const CalibrationObservation& seen,
                                             const Eigen::Vector3d& in_camera) const {
  return residual_.At(model_, problem_.views[seen.view].velocity, seen, in_camera);
}

// A wrong point may lie in the centre of a camera, where a tiny step moves its image anywhere: its
// derivatives are so large that no step of the others is possible. A point behind a camera has an
// infinite error.
void CameraAdjustment::DropPointsInCameras() {
  constexpr size_t kFewest = 2;
  const double nearest =
      0.02 * MedianOf([](const CalibrationObservation&, const Eigen::Vector3d& in_camera) {
        return in_camera.z();
      });
  size_t kept = 0;
  for (size_t i = 0; i < problem_.points.size(); ++i) {
    std::vector<CalibrationObservation>& observations = problem_.observations[i];
    std::erase_if(observations, [&](const CalibrationObservation& seen) {
      return (problem_.views[seen.view].cam_from_world * problem_.points[i]).z() < nearest;
    });
    if (observations.size() >= kFewest) {
      problem_.points[kept] = problem_.points[i];
      std::swap(problem_.observations[kept], observations);
      ++kept;
    }
  }
  problem_.points.resize(kept);
  problem_.observations.resize(kept);
}

// With a wrong camera most errors are beyond the scale of the loss, and would hardly pull. So it
// begins with a scale that most errors are within.
void CameraAdjustment::Solve(const Options& options) {
  constexpr int kRounds = 4;
  DropPointsInCameras();
  for (int round = 0; round < kRounds; ++round) {
    const double excess = std::max(
        1.0, MedianOf([&](const CalibrationObservation& seen, const auto& in_camera) {
          return ResidualOf(seen, in_camera).norm() / std::sqrt(seen.disparity > 0.0 ? 3.0 : 2.0);
        }));
    loss_scale_ = kCauchyScale * excess;
    cost_ = Cost(model_, problem_.views, problem_.points);
    Minimise(options);
    if (excess == 1.0) {
      break;
    }
  }
  loss_scale_ = kCauchyScale;
  cost_ = Cost(model_, problem_.views, problem_.points);
}

// The damping follows how well the last step was predicted (Nielsen 1999).
void CameraAdjustment::Minimise(const Options& options) {
  const std::vector<uint8_t> all(problem_.views.size(), 0);
  double damping = 1e-4;
  double growth = 2.0;
  for (int i = 0; i < options.max_iterations; ++i) {
    std::vector<PointSystem> points;
    const ReducedSystem system = Reduce(damping, all, &points);
    const Eigen::LLT<Eigen::MatrixXd> factors(system.hessian);
    if (factors.info() != Eigen::Success) {
      damping = std::max(10.0 * damping, 1e-6);
      continue;
    }
    const Eigen::VectorXd step = -factors.solve(system.gradient);
    CameraModel model = model_;
    for (size_t k = 0; k < parameters_.size(); ++k) {
      parameters_[k].Move(step[camera_row() + static_cast<Eigen::Index>(k)], model);
    }
    std::vector<CalibrationView> views = problem_.views;
    for (size_t k = 0; k < views.size(); ++k) {
      views[k].cam_from_world =
          ViewAfterStep(views[k].cam_from_world, step.segment<6>(6 * static_cast<Eigen::Index>(k)));
    }
    std::vector<Eigen::Vector3d> moved = problem_.points;
    double predicted = -system.gradient.dot(step);
    for (size_t k = 0; k < moved.size(); ++k) {
      Eigen::Vector3d gradient = points[k].gradient;
      predicted += gradient.dot(points[k].inverse * gradient);
      for (const PointSystem::Coupling& one : points[k].couplings) {
        gradient.noalias() += one.block.transpose() * step.segment<6>(one.row);
      }
      gradient.noalias() += points[k].by_camera.transpose() *
                            step.tail(static_cast<Eigen::Index>(parameters_.size()));
      const size_t first = problem_.observations[k].front().view;
      moved[k] =
          PointAfterStep(problem_.views[first].cam_from_world,
                         step.segment<6>(6 * static_cast<Eigen::Index>(first)),
                         views[first].cam_from_world, moved[k], -(points[k].inverse * gradient));
    }
    const double cost = model.camera.FindFault().empty() ? Cost(model, views, moved) : kInfinite;
    if (!(cost < cost_)) {
      constexpr double kMostDamping = 1e8;
      damping *= growth;
      growth *= 2.0;
      if (damping > kMostDamping) {
        break;
      }
      continue;
    }
    const double surprise = 2.0 * (cost_ - cost) / (0.5 * predicted) - 1.0;
    const bool is_done = cost_ - cost < options.tolerance * cost_;
    model_ = model;
    problem_.views = std::move(views);
    problem_.points = std::move(moved);
    cost_ = cost;
    damping = std::max(std::clamp(1.0 - surprise * surprise * surprise, 0.1, 2.0) * damping, 1e-10);
    growth = 2.0;
    if (is_done) {
      break;
    }
  }
}

Eigen::MatrixXd CameraAdjustment::CameraInformation(const ReducedSystem& system,
                                                    Eigen::VectorXd* gradient) const {
  const Eigen::Index camera = camera_row();
  const auto numbers = static_cast<Eigen::Index>(parameters_.size());
  const Eigen::MatrixXd poses = system.hessian.topLeftCorner(camera, camera);
  const Eigen::MatrixXd coupling = system.hessian.bottomLeftCorner(numbers, camera);
  const Eigen::LLT<Eigen::MatrixXd> factors(poses);
  const Eigen::MatrixXd solved = factors.solve(coupling.transpose());
  Eigen::MatrixXd information = system.hessian.bottomRightCorner(numbers, numbers);
  information = information.selfadjointView<Eigen::Lower>();
  information -= coupling * solved;
  if (gradient != nullptr) {
    *gradient = system.gradient.tail(numbers) - solved.transpose() * system.gradient.head(camera);
  }
  return information;
}

CameraAdjustment::Minimum CameraAdjustment::AtMinimum() const {
  const ReducedSystem system = Reduce(0.0, std::vector<uint8_t>(problem_.views.size(), 0), nullptr);
  const double unknown = 3.0 * static_cast<double>(problem_.points.size()) +
                         static_cast<double>(system.gradient.size());
  return {.information = CameraInformation(system, nullptr),
          .variance_factor = system.weighted_chi2 / std::max(1.0, system.weight - unknown)};
}

Eigen::VectorXd CameraAdjustment::StepWithout(const std::vector<uint8_t>& is_left_out) const {
  const ReducedSystem system = Reduce(0.0, is_left_out, nullptr);
  Eigen::VectorXd gradient;
  const Eigen::MatrixXd information = CameraInformation(system, &gradient);
  return -information.ldlt().solve(gradient);
}

double CameraAdjustment::MedianError() const {
  return MedianOf([&](const CalibrationObservation& seen, const Eigen::Vector3d& in_camera) {
    return seen.sigma * ResidualOf(seen, in_camera).head<2>().norm();
  });
}

double CameraAdjustment::DisparitySigma() const {
  constexpr double kLeast = 0.05;            // px
  constexpr double kSigmaOfMedian = 1.4826;  // of normal errors
  std::vector<double> errors;
  for (size_t i = 0; i < problem_.points.size(); ++i) {
    for (const CalibrationObservation& seen : problem_.observations[i]) {
      if (seen.disparity > 0.0) {
        const Rigid3& cam_from_world = problem_.views[seen.view].cam_from_world;
        errors.push_back(std::abs(ResidualOf(seen, cam_from_world * problem_.points[i]).z()));
      }
    }
  }
  const double sigma = problem_.disparity_sigma;
  return errors.empty() ? sigma
                        : std::max(kLeast, kSigmaOfMedian * sigma * Median(std::move(errors)));
}

double MedianSpeed(const CalibrationProblem& problem, const CameraModel& model) {
  constexpr double kStep = 1e-3;  // s
  std::vector<double> speeds;
  for (size_t i = 0; i < problem.points.size(); ++i) {
    for (const CalibrationObservation& seen : problem.observations[i]) {
      const CalibrationView& view = problem.views[seen.view];
      const Eigen::Vector3d in_camera = view.cam_from_world * problem.points[i];
      if (in_camera.z() > 0.0) {
        speeds.push_back((model.Project(in_camera, view.velocity, kStep) -
                          model.Project(in_camera, view.velocity, -kStep))
                             .norm() /
                         (2.0 * kStep));
      }
    }
  }
  return speeds.empty() ? 0.0 : Median(std::move(speeds));
}

}  // namespace hullslam
