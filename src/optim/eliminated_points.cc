// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/eliminated_points.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hullslam::internal {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Levenberg-Marquardt of a single point. If a step is expected to lower the cost by less than
// kNegligible times (1 + cost), the decrease is smaller than the rounding errors.
constexpr int kTrialsPerStep = 3;
constexpr double kNegligible = 1e-9;
constexpr double kLeastDamping = 1e-8;   // relative to the diagonal
constexpr double kFailedDamping = 1e-2;  // after the first step that failed
constexpr double kMostDamping = 1e6;

// `lower`: the Hessian; only its lower half is used.
Eigen::Matrix3d DampedInverse(const Eigen::Matrix3d& lower, double damping) {
  Eigen::Matrix3d hessian = lower.selfadjointView<Eigen::Lower>();
  // A point in a single view without depth is not constrained along its ray. `floor` keeps its
  // Hessian invertible.
  const double floor = 1e-9 * hessian.trace();
  hessian.diagonal() += damping * hessian.diagonal() + Eigen::Vector3d::Constant(floor);
  return hessian.inverse();
}

}  // namespace

EliminatedPoints::EliminatedPoints(const PinholeCamera& camera, BundlePoints& points, size_t moving,
                                   PointLoss loss, const FollowOptions& follow)
    : camera_(camera),
      points_(points),
      moving_(moving),
      loss_(loss),
      follow_(follow),
      moved_(points.positions()),
      damping_(points.size(), kLeastDamping) {}

double EliminatedPoints::Loss(double chi2,
                              const BundlePoints::PointObservation& observation) const {
  const double loss = loss_ == PointLoss::kHuber
                          ? HuberCost(chi2, OutlierBound(observation.measurement))
                      : loss_ == PointLoss::kCauchy ? CauchyCost(chi2, kCauchyScale)
                                                    : chi2;
  return 0.5 * observation.weight * loss;
}

double EliminatedPoints::WeightOf(double chi2,
                                  const BundlePoints::PointObservation& observation) const {
  const double weight = loss_ == PointLoss::kHuber
                            ? HuberWeight(chi2, OutlierBound(observation.measurement))
                        : loss_ == PointLoss::kCauchy ? CauchyWeight(chi2, kCauchyScale)
                                                      : 1.0;
  return observation.weight * weight;
}

double EliminatedPoints::CostOf(size_t point, const Eigen::Vector3d& position) const {
  double cost = 0.0;
  for (const BundlePoints::PointObservation& observation :
       std::as_const(points_).ObservationsOf(point)) {
    if (observation.is_inlier) {
      const double chi2 =
          PointChi2(camera_, observation.measurement, poses_[observation.pose] * position);
      cost += Loss(chi2 < kInfinite ? chi2 : follow_.chi2_behind, observation);
    }
  }
  return cost;
}

EliminatedPoints::PointSystem EliminatedPoints::SystemOf(size_t point,
                                                         const Eigen::Vector3d& position) const {
  PointSystem sum;
  for (const BundlePoints::PointObservation& observation :
       std::as_const(points_).ObservationsOf(point)) {
    if (!observation.is_inlier) {
      continue;
    }
    const Eigen::Vector3d in_camera = poses_[observation.pose] * position;
    if (in_camera.z() < kMinDepth) {
      sum.cost += Loss(follow_.chi2_behind, observation);
      continue;
    }
    const PointLinearization linear(camera_, observation.measurement, in_camera);
    const double chi2 = linear.residual.squaredNorm();
    sum.cost += Loss(chi2, observation);
    sum.Add(WeightOf(chi2, observation), linear.residual,
            linear.Times(poses_[observation.pose].rotation));
  }
  return sum;
}

double EliminatedPoints::MovePoint(size_t point, Eigen::Vector3d& position, double& damping) const {
  PointSystem here = SystemOf(point, position);
  int steps = 0;
  for (int trial = 0; trial < kTrialsPerStep * follow_.steps && here.cost < kInfinite; ++trial) {
    const Eigen::Vector3d step = -DampedInverse(here.hessian, damping) * here.gradient;
    const double expected = -here.gradient.dot(step);
    const Eigen::Vector3d next = position + step;
    const double cost = CostOf(point, next);
    if (!(cost < here.cost)) {
      if (expected < kNegligible * (1.0 + here.cost)) {
        break;
      }
      damping = std::clamp(100.0 * damping, kFailedDamping, kMostDamping);
      continue;
    }
    position = next;
    damping = std::max(0.1 * damping, kLeastDamping);
    here.cost = cost;
    if (++steps == follow_.steps || expected < follow_.worthwhile * cost) {
      break;
    }
    here = SystemOf(point, position);
  }
  return here.cost;
}

double EliminatedPoints::Follow(std::span<const Rigid3> poses) {
  poses_.clear();
  for (const Rigid3& pose : poses) {
    poses_.emplace_back(pose);
  }
  double cost = 0.0;
  for (size_t i = 0; i < points_.size(); ++i) {
    moved_[i] = points_.positions()[i];
    cost += MovePoint(i, moved_[i], damping_[i]);
  }
  return cost;
}

void EliminatedPoints::Accept() { points_.positions() = moved_; }

// A step (w, v) of a pose moves a point x of the camera frame by -[x]_x w + v.
template <typename BlockAt>
void EliminatedPoints::AddView(const BundlePoints::PointObservation& observation,
                               const Eigen::Vector3d& position, const BlockAt& block_at,
                               PointSystem& point, Eigen::VectorXd& gradient) {
  const MatrixPose& pose = poses_[observation.pose];
  const Eigen::Vector3d in_camera = pose * position;
  if (in_camera.z() < kMinDepth) {
    return;
  }
  const PointLinearization linear(camera_, observation.measurement, in_camera);
  const double weight = WeightOf(linear.residual.squaredNorm(), observation);
  point.Add(weight, linear.residual, linear.Times(pose.rotation));
  if (observation.pose >= moving_) {
    return;
  }
  const Eigen::Matrix3d by_camera_point = weight * linear.Hessian();
  const Eigen::Vector3d slope = weight * linear.Gradient();
  const Eigen::Matrix3d by_rotation = -by_camera_point.colwise().cross(in_camera);  // [x]_x H
  const auto at = 6 * static_cast<Eigen::Index>(observation.pose);
  auto&& hessian = block_at(observation.pose, observation.pose);
  hessian.template block<3, 3>(0, 0) -= by_rotation.rowwise().cross(in_camera.transpose());
  hessian.template block<3, 3>(3, 0) += by_rotation.transpose();
  hessian.template block<3, 3>(3, 3) += by_camera_point;
  gradient.segment<3>(at) += in_camera.cross(slope);
  gradient.segment<3>(at + 3) += slope;
  Coupling& coupling = couplings_.emplace_back();
  coupling.pose = observation.pose;
  coupling.block.topRows<3>().noalias() = by_rotation * pose.rotation;
  coupling.block.bottomRows<3>().noalias() = by_camera_point * pose.rotation;
}

template <typename BlockAt>
void EliminatedPoints::Eliminate(const PointSystem& point, double damping, const BlockAt& block_at,
                                 Eigen::VectorXd& gradient) const {
  const Eigen::Matrix3d inverse = DampedInverse(point.hessian, damping);
  for (const Coupling& row : couplings_) {
    const Eigen::Matrix<double, 6, 3> solved = row.block * inverse;
    gradient.segment<6>(6 * static_cast<Eigen::Index>(row.pose)).noalias() -=
        solved * point.gradient;
    for (const Coupling& column : couplings_) {
      if (column.pose <= row.pose) {
        block_at(row.pose, column.pose).noalias() -= solved * column.block.transpose();
      }
    }
  }
}

template <typename BlockAt>
void EliminatedPoints::Sum(const BlockAt& block_at, Eigen::VectorXd& gradient) {
  gradient.setZero(static_cast<Eigen::Index>(6 * moving_));
  for (size_t i = 0; i < points_.size(); ++i) {
    PointSystem point;
    couplings_.clear();
    for (const BundlePoints::PointObservation& observation :
         std::as_const(points_).ObservationsOf(i)) {
      if (observation.is_inlier) {
        AddView(observation, points_.positions()[i], block_at, point, gradient);
      }
    }
    Eliminate(point, damping_[i], block_at, gradient);
  }
}

void EliminatedPoints::Linearize(Eigen::MatrixXd& hessian, Eigen::VectorXd& gradient) {
  const auto size = static_cast<Eigen::Index>(6 * moving_);
  hessian.setZero(size, size);
  const auto block_at = [&](size_t row, size_t column) {
    return hessian.block<6, 6>(6 * static_cast<Eigen::Index>(row),
                               6 * static_cast<Eigen::Index>(column));
  };
  Sum(block_at, gradient);
}

void EliminatedPoints::Linearize(BlockCholesky& hessian, Eigen::VectorXd& gradient) {
  hessian.SetZero();
  Sum(
      [&](size_t row, size_t column) -> auto& { return hessian.At(row, column); }, gradient);
}

std::vector<std::set<uint32_t>> EliminatedPoints::CoupledPoses() const {
  std::vector<std::set<uint32_t>> coupled(moving_);
  for (size_t i = 0; i < points_.size(); ++i) {
    for (const auto& one : std::as_const(points_).ObservationsOf(i)) {
      for (const auto& other : std::as_const(points_).ObservationsOf(i)) {
        if (one.is_inlier && other.is_inlier && one.pose < other.pose && other.pose < moving_) {
          coupled[one.pose].insert(static_cast<uint32_t>(other.pose));
        }
      }
    }
  }
  return coupled;
}

}  // namespace hullslam::internal
