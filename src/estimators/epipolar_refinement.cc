// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimators/epipolar_refinement.h"

#include <ceres/jet.h>
#include <ceres/rotation.h>
#include <ceres/tiny_solver.h>
#include <ceres/tiny_solver_autodiff_function.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <vector>

namespace hullslam {
namespace {

// A pair as rays of depth 1, with the covariances of the rays' x and y.
struct RayPair {
  Eigen::Vector3d a;
  Eigen::Vector3d b;
  Eigen::Matrix2d covariance_a;
  Eigen::Matrix2d covariance_b;
};

// The errors of a ray follow from those of its raw pixel.
Eigen::Matrix2d RayCovariance(const PinholeCamera& camera, const Eigen::Vector2d& pixel,
                              double sigma) {
  const Eigen::Matrix2d ray_by_raw =
      Eigen::Vector2d(1.0 / camera.fx, 1.0 / camera.fy).asDiagonal() *
      camera.DistortionJacobian(pixel).inverse();
  return sigma * sigma * ray_by_raw * ray_by_raw.transpose();
}

RayPair ToRays(const PinholeCamera& camera, const PixelPair& pair) {
  return {.a = camera.Unproject(pair.a, 1.0),
          .b = camera.Unproject(pair.b, 1.0),
          .covariance_a = RayCovariance(camera, pair.a, pair.sigma_a),
          .covariance_b = RayCovariance(camera, pair.b, pair.sigma_b)};
}

// The signed square root of SampsonError.
template <typename T>
T SampsonDistance(const RayPair& pair, const Eigen::Matrix<T, 3, 3>& rotation,
                  const Eigen::Matrix<T, 3, 1>& translation) {
  const Eigen::Matrix<T, 3, 1> b = pair.b.cast<T>();
  const Eigen::Matrix<T, 3, 1> line_in_b = translation.cross(rotation * pair.a.cast<T>());
  const Eigen::Matrix<T, 3, 1> line_in_a = rotation.transpose() * b.cross(translation);
  const Eigen::Matrix<T, 2, 1> normal_in_a = line_in_a.template head<2>();
  const Eigen::Matrix<T, 2, 1> normal_in_b = line_in_b.template head<2>();
  const T variance = normal_in_a.dot(pair.covariance_a.cast<T>() * normal_in_a) +
                     normal_in_b.dot(pair.covariance_b.cast<T>() * normal_in_b);
  // A pair at both epipoles has no epipolar line; it agrees with the motion.
  constexpr double kTiny = 1e-30;
  return b.dot(line_in_b) / sqrt(variance + kTiny);
}

// The residuals of a motion that differs from a first one by a rotation vector and by two
// components perpendicular to the translation.
class MotionFunction {
 public:
  MotionFunction(const PinholeCamera& camera, std::span<const PixelPair> pairs,
                 const Rigid3& b_from_a, double noise)
      : rotation_(b_from_a.rotation.toRotationMatrix()),
        translation_(b_from_a.translation.normalized()),
        noise_(noise) {
    across_.col(0) = translation_.unitOrthogonal();
    across_.col(1) = translation_.cross(across_.col(0));
    for (const PixelPair& pair : pairs) {
      pairs_.push_back(ToRays(camera, pair));
    }
  }

  int NumResiduals() const { return static_cast<int>(pairs_.size()); }

  template <typename T>
  bool operator()(const T* change, T* residuals) const {
    Eigen::Matrix<T, 3, 3> rotation;
    Eigen::Matrix<T, 3, 1> translation;
    Apply(change, rotation, translation);
    for (size_t i = 0; i < pairs_.size(); ++i) {
      const T error = SampsonDistance(pairs_[i], rotation, translation) / noise_;
      residuals[i] = error / sqrt(1.0 + error * error / kMaxPairCost);
    }
    return true;
  }

  Rigid3 At(const Eigen::Matrix<double, 5, 1>& change) const {
    Eigen::Matrix3d rotation;
    Eigen::Vector3d translation;
    Apply(change.data(), rotation, translation);
    return {Eigen::Quaterniond(rotation).normalized(), translation.normalized()};
  }

 private:
  template <typename T>
  void Apply(const T* change, Eigen::Matrix<T, 3, 3>& rotation,
             Eigen::Matrix<T, 3, 1>& translation) const {
    Eigen::Matrix<T, 3, 3> turn;
    ceres::AngleAxisToRotationMatrix(change, turn.data());
    rotation = turn * rotation_.cast<T>();
    translation = translation_.cast<T>() + across_.col(0).cast<T>() * change[3] +
                  across_.col(1).cast<T>() * change[4];
  }

  Eigen::Matrix3d rotation_;
  Eigen::Vector3d translation_;
  Eigen::Matrix<double, 3, 2> across_;
  double noise_;
  std::vector<RayPair> pairs_;
};

}  // namespace

double SampsonError(const PinholeCamera& camera, const Rigid3& b_from_a, const PixelPair& pair) {
  const double distance = SampsonDistance<double>(
      ToRays(camera, pair), b_from_a.rotation.toRotationMatrix(), b_from_a.translation);
  return distance * distance;
}

double PairCost(const PinholeCamera& camera, const Rigid3& b_from_a, const PixelPair& pair,
                double noise) {
  const double error = SampsonError(camera, b_from_a, pair) / (noise * noise);
  return error / (1.0 + error / kMaxPairCost);
}

Rigid3 RefineMotion(const PinholeCamera& camera, std::span<const PixelPair> pairs,
                    const Rigid3& b_from_a, double noise) {
  using Function = ceres::TinySolverAutoDiffFunction<MotionFunction, Eigen::Dynamic, 5>;
  const MotionFunction motion(camera, pairs, b_from_a, noise);
  const Function function(motion);
  ceres::TinySolver<Function> solver;
  Eigen::Matrix<double, 5, 1> change = Eigen::Matrix<double, 5, 1>::Zero();
  solver.Solve(function, &change);
  return motion.At(change);
}

}  // namespace hullslam
