// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "objects/start_method.h"

namespace hullslam {
namespace {

using Row = Eigen::Matrix<double, 1, 10>;

constexpr size_t kLeastObservations = 3;

// The coefficients of pi^T Q pi in the ten different elements of Q, row by row.
Row CoefficientsOf(const Eigen::Vector4d& plane) {
  Row row;
  int column = 0;
  for (int i = 0; i < 4; ++i) {
    for (int j = i; j < 4; ++j) {
      row[column++] = (i == j ? 1.0 : 2.0) * plane[i] * plane[j];
    }
  }
  return row;
}

Eigen::Matrix4d QuadricOf(const Eigen::Matrix<double, 10, 1>& elements) {
  Eigen::Matrix4d quadric;
  int element = 0;
  for (int i = 0; i < 4; ++i) {
    for (int j = i; j < 4; ++j) {
      quadric(i, j) = quadric(j, i) = elements[element++];
    }
  }
  return quadric;
}

std::vector<ResolvedObservation> ObservationsWithWholeBox(
    std::span<const ResolvedObservation> observations) {
  std::vector<ResolvedObservation> whole;
  std::copy_if(
      observations.begin(), observations.end(), std::back_inserter(whole),
      [](const ResolvedObservation& observation) { return !observation.detection->is_cut; });
  return whole.size() >= kLeastObservations
             ? whole
             : std::vector<ResolvedObservation>(observations.begin(), observations.end());
}

// The planes through the camera and the sides of the box, with unit normals, where
// `local_from_world` is x -> (x - center) / scale.
void AddPlanes(const PinholeCamera& camera, const ResolvedObservation& observation,
               const Eigen::Vector3d& center, double scale, std::vector<Row>& rows) {
  const Eigen::AlignedBox2d& box = observation.detection->box;
  Eigen::Matrix<double, 3, 4> projection;
  projection << observation.cam_from_world.rotation.toRotationMatrix() * scale,
      observation.cam_from_world * center;
  projection = camera.Matrix() * projection;
  for (const Eigen::Vector3d& line :
       {Eigen::Vector3d(1.0, 0.0, -box.min().x()), Eigen::Vector3d(1.0, 0.0, -box.max().x()),
        Eigen::Vector3d(0.0, 1.0, -box.min().y()), Eigen::Vector3d(0.0, 1.0, -box.max().y())}) {
    const Eigen::Vector4d plane = projection.transpose() * line;
    rows.push_back(CoefficientsOf(plane / plane.head<3>().norm()));
  }
}

bool IsInFrontOfAll(const Ellipsoid& ellipsoid, std::span<const ResolvedObservation> observations) {
  return std::all_of(
      observations.begin(), observations.end(), [&](const ResolvedObservation& observation) {
        return (observation.cam_from_world * ellipsoid.world_from_object.translation).z() > 0.0;
      });
}

}  // namespace

std::optional<Ellipsoid> EllipsoidOfDualQuadric(const Eigen::Matrix4d& quadric) {
  const Eigen::Matrix4d scaled = quadric / -quadric(3, 3);
  const Eigen::Vector3d center = -scaled.topRightCorner<3, 1>();
  const Eigen::Matrix3d shape = scaled.topLeftCorner<3, 3>() + center * center.transpose();
  if (!scaled.allFinite()) {
    return std::nullopt;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(shape);
  Eigen::Matrix3d axes = eigen.eigenvectors();
  if (axes.determinant() < 0.0) {
    axes.col(2) = -axes.col(2);
  }
  Ellipsoid ellipsoid;
  ellipsoid.world_from_object = Rigid3(Eigen::Quaterniond(axes).normalized(), center);
  ellipsoid.half_axes = eigen.eigenvalues().cwiseAbs().cwiseSqrt();
  const bool is_good = ellipsoid.half_axes.allFinite() && ellipsoid.half_axes.minCoeff() > 0.0;
  return is_good ? std::optional(ellipsoid) : std::nullopt;
}

std::vector<Ellipsoid> StartByBoxPlanes(const StartInput& input) {
  if (input.observations.size() < kLeastObservations) {
    return {};
  }
  const double scale = MeanDistance(input.observations, input.center);
  std::vector<Row> rows;
  for (const ResolvedObservation& observation : ObservationsWithWholeBox(input.observations)) {
    AddPlanes(input.camera, observation, input.center, scale, rows);
  }
  Eigen::MatrixXd equations(rows.size(), 10);
  for (size_t i = 0; i < rows.size(); ++i) {
    equations.row(static_cast<Eigen::Index>(i)) = rows[i];
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(equations, Eigen::ComputeFullV);
  std::optional<Ellipsoid> ellipsoid = EllipsoidOfDualQuadric(QuadricOf(svd.matrixV().col(9)));
  if (!ellipsoid) {
    return {};
  }
  ellipsoid->half_axes =
      (scale * ellipsoid->half_axes)
          .cwiseMax(Eigen::Vector3d::Constant(input.options.min_half_axis * scale));
  Eigen::Vector3d& center = ellipsoid->world_from_object.translation;
  center = input.center + scale * center;
  return IsInFrontOfAll(*ellipsoid, input.observations) ? std::vector<Ellipsoid>{*ellipsoid}
                                                        : std::vector<Ellipsoid>();
}

}  // namespace hullslam
