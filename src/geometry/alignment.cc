// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/geometry/alignment.h"

#include <Eigen/Dense>
#include <vector>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

using Points = Eigen::Matrix3Xd;

Points ToMatrix(std::span<const Eigen::Vector3d> points) {
  Points matrix(3, points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    matrix.col(i) = points[i];
  }
  return matrix;
}

std::vector<Eigen::Vector3d> PointsOnAxes(std::span<const Rigid3> poses, double lever) {
  std::vector<Eigen::Vector3d> points;
  for (const Rigid3& pose : poses) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double distance : {lever, -lever}) {
        points.push_back(pose * Eigen::Vector3d(distance * Eigen::Vector3d::Unit(axis)));
      }
    }
  }
  return points;
}

bool HasSpread(const Points& points) {
  const double extent =
      (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).cwiseAbs().maxCoeff();
  const double magnitude = points.cwiseAbs().maxCoeff();
  return extent > 1e-12 * magnitude;
}

}  // namespace

PointAlignment AlignPoints(std::span<const Eigen::Vector3d> source,
                           std::span<const Eigen::Vector3d> target, AlignmentKind kind) {
  Check(source.size() == target.size(),
        "the alignment needs as many source points as target points");
  PointAlignment alignment;
  if (kind == AlignmentKind::kNone) {
    return alignment;
  }
  if (source.size() < 3) {
    alignment.failure =
        "an alignment needs at least 3 pairs, there are " + std::to_string(source.size());
    return alignment;
  }
  const Points sources = ToMatrix(source);
  const Points targets = ToMatrix(target);
  const bool with_scale = kind == AlignmentKind::kSim3;
  if (with_scale && (!HasSpread(sources) || !HasSpread(targets))) {
    alignment.failure = "the scale is not fixed by points that all coincide";
    return alignment;
  }
  const Eigen::Matrix4d matrix = Eigen::umeyama(sources, targets, with_scale);
  const Eigen::Matrix3d scaled_rotation = matrix.topLeftCorner<3, 3>();
  alignment.scale = with_scale ? scaled_rotation.col(0).norm() : 1.0;
  alignment.target_from_source.rotation =
      Eigen::Quaterniond(Eigen::Matrix3d(scaled_rotation / alignment.scale)).normalized();
  alignment.target_from_source.translation = matrix.topRightCorner<3, 1>();
  return alignment;
}

Rigid3 AlignPoses(std::span<const Rigid3> source, std::span<const Rigid3> target, double lever) {
  Check(!source.empty() && source.size() == target.size() && lever > 0.0,
        "the alignment needs as many source poses as target poses, and a positive lever");
  return AlignPoints(PointsOnAxes(source, lever), PointsOnAxes(target, lever), AlignmentKind::kSe3)
      .target_from_source;
}

}  // namespace hullslam
