// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/box_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "objects/constraint/misfit.h"
#include "optim/robust.h"
#include "scene/object_body.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

constexpr size_t kFewestPlanes = 24;  // of six unknown numbers
constexpr int kTurns = 30;            // rotations that are tried, of a quarter of a turn
constexpr double kLeastSide = 0.01;   // of the mean half axis of the ellipsoid
// The half extents are those of the box around the ellipsoid, with this standard deviation, as a
// share of the mean half axis.
constexpr double kPriorShare = 0.5;
// The weight of a plane beyond the box, relative to that of one that cuts it.
constexpr double kBeyond = 8.0;
// The cost of a box relative to that of the ellipsoid, until it is taken: for a box without
// thickness, which lines that contradict one another give, too, and for others.
constexpr double kFlatShare = 0.25;
constexpr double kBoxShare = 0.7;

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

Eigen::Quaterniond TurnAboutZ(double angle) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
}

// The derivative of the support of a box by its centre and its half extents.
Vector6d BySides(const Eigen::Vector3d& normal, const Eigen::Quaterniond& rotation) {
  Vector6d derivative;
  derivative << normal, (rotation.conjugate() * normal).cwiseAbs();
  return derivative;
}

// The centre and the half extents of a box for one rotation.
class Fit {
 public:
  Fit(std::span<const SupportPlane> planes, const Ellipsoid& ellipsoid, double scale, double angle,
      double beyond = 1.0)
      : planes_(planes), rotation_(TurnAboutZ(angle)), scale_(scale), beyond_(beyond) {
    const double size = ellipsoid.half_axes.mean();
    least_ = kLeastSide * size;
    sides_.head<3>() = ellipsoid.world_from_object.translation;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d axis = rotation_ * Eigen::Vector3d::Unit(i);
      sides_[3 + i] = SupportOf(ellipsoid, axis) - axis.dot(sides_.head<3>());
    }
    prior_ = sides_;
    prior_information_ = 1.0 / (kPriorShare * kPriorShare * size * size);
    constexpr int kSteps = 8;  // of the weights
    for (int i = 0; i < kSteps; ++i) {
      Step();
    }
    for (const SupportPlane& plane : planes_) {
      const double error = ErrorOf(plane) / scale_;
      cost_ += CauchyCost(error * error, 1.0);
    }
  }

  double cost() const { return cost_; }
  bool IsFlat() const { return sides_.tail<3>().minCoeff() <= least_; }

  UprightBox Box() const { return {Rigid3(rotation_, sides_.head<3>()), sides_.tail<3>()}; }

 private:
  double ErrorOf(const SupportPlane& plane) const {  // px
    return plane.pixels_per_metre * (BySides(plane.normal, rotation_).dot(sides_) - plane.support);
  }

  void Step() {
    Matrix6d information = Matrix6d::Zero();
    Vector6d right = Vector6d::Zero();
    for (int i = 3; i < 6; ++i) {
      information(i, i) = prior_information_;
      right[i] = prior_information_ * prior_[i];
    }
    for (const SupportPlane& plane : planes_) {
      const double error = ErrorOf(plane) / scale_;
      const double share = plane.pixels_per_metre / scale_;
      const double weight =
          CauchyWeight(error * error, 1.0) * share * share * (error < 0.0 ? beyond_ : 1.0);
      const Vector6d derivative = BySides(plane.normal, rotation_);
      information += weight * derivative * derivative.transpose();
      right += weight * plane.support * derivative;
    }
    sides_ = information.ldlt().solve(right);
    sides_.tail<3>() = sides_.tail<3>().cwiseMax(least_);
  }

  std::span<const SupportPlane> planes_;
  const Eigen::Quaterniond rotation_;
  const double scale_;  // px
  const double beyond_;
  double least_ = 0.0;  // m, the least half extent
  double prior_information_ = 0.0;
  Vector6d prior_;
  Vector6d sides_;
  double cost_ = 0.0;
};

}  // namespace

std::vector<SupportPlane> SupportPlanesOf(const PinholeCamera& camera, const Ellipsoid& ellipsoid,
                                          std::span<const ResolvedObservation> observations,
                                          const Eigen::Quaterniond& frame_from_world) {
  const Rigid3& pose = ellipsoid.world_from_object;
  std::vector<SupportPlane> planes;
  size_t view = 0;
  for (const ResolvedObservation& observation : observations) {
    ++view;
    for (const SilhouetteLine& line : observation.detection->lines) {
      const auto plane = PlaneOfLine(camera, observation.cam_from_world, ellipsoid, line.line);
      if (line.is_one_sided || !plane) {
        continue;
      }
      const Eigen::Vector3d in_world = pose.rotation * plane->normal;
      planes.push_back({.normal = frame_from_world * in_world,
                        .support = SupportOf(ellipsoid, in_world) + plane->excess,
                        .pixels_per_metre = plane->pixels_per_metre,
                        .view = view});
    }
  }
  return planes;
}

std::optional<UprightBox> FitBox(std::span<const SupportPlane> planes, const Ellipsoid& ellipsoid) {
  if (planes.size() < kFewestPlanes) {
    return std::nullopt;
  }
  std::vector<double> errors;
  for (const SupportPlane& plane : planes) {
    errors.push_back(plane.pixels_per_metre *
                     std::abs(SupportOf(ellipsoid, plane.normal) - plane.support));
  }
  const double scale = std::max(1.0, Median(std::vector<double>(errors)));  // px
  double round_cost = 0.0;
  for (const double error : errors) {
    round_cost += CauchyCost(error * error / (scale * scale), 1.0);
  }
  constexpr double kStep = 0.5 * std::numbers::pi / kTurns;
  const auto fit_at = [&](double turn) { return Fit(planes, ellipsoid, scale, kStep * turn); };
  double best = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (int turn = 0; turn < kTurns; ++turn) {
    if (const double cost = fit_at(turn).cost(); cost < least) {
      least = cost;
      best = turn;
    }
  }
  for (double step = 0.5; step > 0.05; step *= 0.5) {
    for (const double turn : {best - step, best + step}) {
      if (const double cost = fit_at(turn).cost(); cost < least) {
        least = cost;
        best = turn;
      }
    }
  }
  const Fit fit(planes, ellipsoid, scale, kStep * best, kBeyond);
  if (least >= (fit.IsFlat() ? kFlatShare : kBoxShare) * round_cost) {
    return std::nullopt;
  }
  return fit.Box();
}

void FindSeenSides(std::span<const SupportPlane> planes, const Eigen::Quaterniond& frame_from_world,
                   UprightBox& box) {
  std::array<std::set<size_t>, 6> views;  // that touch each side
  const Eigen::Quaterniond box_from_frame =
      (frame_from_world * box.world_from_box.rotation).conjugate();
  for (const SupportPlane& plane : planes) {
    const Eigen::Vector3d normal = box_from_frame * plane.normal;
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    views.at(2 * static_cast<size_t>(axis) + (normal[axis] > 0.0 ? 1 : 0)).insert(plane.view);
  }
  for (size_t side = 0; side < views.size(); ++side) {
    box.is_seen[side] = views[side].size() >= 2;
  }
}

}  // namespace hullslam
