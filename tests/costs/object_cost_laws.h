// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/cost_function.h>
#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "costs/manifolds.h"
#include "costs/residual_kind.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/geometry/line2.h"
#include "support/random_geometry.h"

namespace hullslam {

constexpr PinholeCamera kObjectCamera{
    .fx = 500.0, .fy = 400.0, .cx = 320.0, .cy = 240.0, .bf = 40.0};

// All residuals, as the table of object_residual.cc names them.
inline std::vector<ObjectResidual> AllResiduals() {
  std::vector<ObjectResidual> residuals;
  for (size_t i = 0; i < ObjectResidualNames().size(); ++i) {
    residuals.push_back(static_cast<ObjectResidual>(i));
  }
  return residuals;
}

// The row of a residual in that table is the one that is expected.
inline void ExpectKind(ObjectResidual residual, const std::string& name, bool takes_lines,
                       const std::vector<ObjectPrimitive>& primitives) {
  EXPECT_EQ(NameOf(residual), name);
  EXPECT_EQ(TakesLines(residual), takes_lines);
  for (const ObjectPrimitive primitive : kAllPrimitives) {
    const bool is_expected =
        std::find(primitives.begin(), primitives.end(), primitive) != primitives.end();
    EXPECT_EQ(AcceptsPrimitive(residual, primitive), is_expected) << NameOf(primitive);
  }
}

// The size of a residual where the outline is 1.5 px outside of a projected ellipse with a radius
// of 20 px, at whose depth a pixel is 1 cm.
inline double SizeOfSomeError(ObjectResidual residual) {
  return KindOf(residual).of_pixel_error(1.5, {.radius_px = 20.0, .depth = 5.0, .focal_px = 500.0});
}

// A camera and an ellipsoid, with their parameter blocks.
struct SeenEllipsoid {
  Rigid3 cam_from_world;
  Ellipsoid ellipsoid;
};

struct ObjectBlocks {
  explicit ObjectBlocks(const SeenEllipsoid& state)
      : camera(ToBlock(state.cam_from_world)),
        object(ToBlock(state.ellipsoid.world_from_object)),
        log_axes(state.ellipsoid.half_axes.array().log()) {}
  std::array<const double*, 3> Pointers() const {
    return {camera.data(), object.data(), log_axes.data()};
  }

  PoseBlock camera;
  PoseBlock object;
  Eigen::Vector3d log_axes;
};

// A random state with the whole ellipsoid in front of the camera and its centre in the image.
inline SeenEllipsoid RandomSeenEllipsoid(RandomGeometry& random) {
  SeenEllipsoid state;
  state.cam_from_world = random.Pose(1.0, 2.0);
  const Rigid3 cam_from_object(
      ExpSo3(random.Vector(1.5)),
      {random.Number(-0.8, 0.8), random.Number(-0.6, 0.6), random.Number(2.0, 5.0)});
  state.ellipsoid.world_from_object = Inverse(state.cam_from_world) * cam_from_object;
  state.ellipsoid.half_axes = {random.Number(0.1, 0.6), random.Number(0.1, 0.6),
                               random.Number(0.1, 0.6)};
  return state;
}

// A sphere of radius 0.6 m, 1 m in front of the camera. Its projected ellipse has the centre
// (320, 240) and the half axes f * 0.6 / sqrt(1 - 0.36) = 375 and 300 px.
inline SeenEllipsoid SphereAhead() {
  SeenEllipsoid state;
  state.ellipsoid.world_from_object.translation = {0.0, 0.0, 1.0};
  state.ellipsoid.half_axes.setConstant(0.6);
  return state;
}

// A point of the projected ellipse and the tangent at this point, computed from the rays that touch
// the ellipsoid. With X = t + A y the ellipsoid is the unit sphere |y| = 1 and the camera's centre
// is o = -A^-1 t. The ray through X touches the sphere if |y| = 1 and y.o = 1. The normal at X is
// along A^-T y.
struct OutlinePoint {
  Eigen::Vector2d pixel;
  Line2 tangent;
};

inline std::vector<OutlinePoint> OutlineOf(const SeenEllipsoid& state, int count) {
  const Rigid3 cam_from_object = state.cam_from_world * state.ellipsoid.world_from_object;
  const Eigen::Matrix3d axes =
      cam_from_object.rotation.toRotationMatrix() * state.ellipsoid.half_axes.asDiagonal();
  const Eigen::Matrix3d k = kObjectCamera.Matrix();
  const Eigen::Vector3d viewer = -axes.inverse() * cam_from_object.translation;
  const Eigen::Vector3d e1 = viewer.unitOrthogonal();
  const Eigen::Vector3d e2 = viewer.normalized().cross(e1);
  const double radius = std::sqrt(1.0 - 1.0 / viewer.squaredNorm());
  std::vector<OutlinePoint> outline;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    const Eigen::Vector3d y =
        viewer / viewer.squaredNorm() + radius * (std::cos(angle) * e1 + std::sin(angle) * e2);
    const Eigen::Vector3d pixel = k * (cam_from_object.translation + axes * y);
    Eigen::Vector3d line = k.inverse().transpose() * axes.inverse().transpose() * y;
    line /= line.head<2>().norm();
    outline.push_back({pixel.hnormalized(), {line.head<2>(), line.z()}});
  }
  return outline;
}

inline std::vector<SilhouetteLine> TangentsOf(const SeenEllipsoid& state, int count) {
  std::vector<SilhouetteLine> lines;
  for (const OutlinePoint& point : OutlineOf(state, count)) {
    lines.push_back({point.tangent, false});
  }
  return lines;
}

inline std::vector<Eigen::Vector2d> ContourOf(const SeenEllipsoid& state, int count) {
  std::vector<Eigen::Vector2d> contour;
  for (const OutlinePoint& point : OutlineOf(state, count)) {
    contour.push_back(point.pixel);
  }
  return contour;
}

// The residuals at a state. If they are not defined, the test fails and they are zero.
inline Eigen::VectorXd ObjectResidualsOf(const ceres::CostFunction& cost,
                                         const SeenEllipsoid& state) {
  const ObjectBlocks blocks(state);
  Eigen::VectorXd residuals = Eigen::VectorXd::Zero(cost.num_residuals());
  EXPECT_TRUE(cost.Evaluate(blocks.Pointers().data(), residuals.data(), nullptr));
  return residuals;
}

// Like AtPose, for a cost with several poses followed by one vector: turns it into a cost on the
// six numbers of the manifold at each pose and the vector.
class AtPoses final : public ceres::CostFunction {
 public:
  AtPoses(const ceres::CostFunction& cost, std::vector<PoseBlock> poses)
      : cost_(cost), poses_(std::move(poses)) {
    set_num_residuals(cost.num_residuals());
    mutable_parameter_block_sizes()->assign(poses_.size(), 6);
    mutable_parameter_block_sizes()->push_back(cost.parameter_block_sizes().back());
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    using ByPose = Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>;
    std::vector<PoseBlock> moved(poses_.size());
    std::vector<ByPose> by_pose(poses_.size(), ByPose(num_residuals(), 7));
    std::vector<const double*> inner;
    std::vector<double*> inner_jacobians;
    for (size_t i = 0; i < poses_.size(); ++i) {
      PoseManifold().Plus(poses_[i].data(), parameters[i], moved[i].data());
      inner.push_back(moved[i].data());
      inner_jacobians.push_back(by_pose[i].data());
    }
    inner.push_back(parameters[poses_.size()]);
    if (jacobians == nullptr) {
      return cost_.Evaluate(inner.data(), residuals, nullptr);
    }
    inner_jacobians.push_back(jacobians[poses_.size()]);
    const bool is_defined = cost_.Evaluate(inner.data(), residuals, inner_jacobians.data());
    for (size_t i = 0; i < poses_.size(); ++i) {
      EXPECT_TRUE(by_pose[i].col(6).isZero(0.0));
      if (jacobians[i] != nullptr) {
        Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>>(
            jacobians[i], num_residuals(), 6) = by_pose[i].leftCols<6>();
      }
    }
    return is_defined;
  }

 private:
  const ceres::CostFunction& cost_;
  std::vector<PoseBlock> poses_;
};

// Expects that each row of each block's Jacobian agrees with numeric differentiation, up to
// `precision` times its largest element. `step` is the first step size that is tried. It must be
// small, because the costs have kinks: a turn by Ceres' default of 0.01 around an origin that is
// metres away would move the projected ellipse by tens of pixels.
inline void ExpectTrueGradientAt(const ceres::CostFunction& cost,
                                 const std::vector<PoseBlock>& poses, const Eigen::Vector3d& last,
                                 double precision, double step = 1e-4) {
  const AtPoses at_poses(cost, poses);
  ceres::NumericDiffOptions options;
  options.ridders_relative_initial_step_size = step;
  const ceres::GradientChecker checker(
      &at_poses, static_cast<std::vector<const ceres::Manifold*>*>(nullptr), options);
  const std::array<double, 6> delta{};
  std::vector<const double*> parameters(poses.size(), delta.data());
  parameters.push_back(last.data());
  ceres::GradientChecker::ProbeResults results;
  checker.Probe(parameters.data(), 1.0, &results);
  ASSERT_TRUE(results.return_value) << results.error_log;
  for (size_t block = 0; block < parameters.size(); ++block) {
    const auto& numeric = results.numeric_jacobians[block];
    const auto error = (results.jacobians[block] - numeric).eval();
    for (int row = 0; row < cost.num_residuals(); ++row) {
      EXPECT_LE(error.row(row).cwiseAbs().maxCoeff(),
                precision * (1e-3 + numeric.row(row).cwiseAbs().maxCoeff()))
          << "block " << block << ", row " << row << ":\n"
          << results.jacobians[block].row(row) << "\nand numerically\n"
          << numeric.row(row);
    }
  }
}

inline void ExpectTrueObjectGradient(const ceres::CostFunction& cost, const SeenEllipsoid& state,
                                     double precision = 1e-6, double step = 1e-4) {
  const ObjectBlocks blocks(state);
  ExpectTrueGradientAt(cost, {blocks.camera, blocks.object}, blocks.log_axes, precision, step);
}

// Moving the world, the camera and the object together does not change the residuals.
inline void ExpectObjectRigidInvariance(const ceres::CostFunction& cost, const SeenEllipsoid& state,
                                        const Rigid3& new_from_old_world) {
  SeenEllipsoid moved = state;
  moved.cam_from_world = state.cam_from_world * Inverse(new_from_old_world);
  moved.ellipsoid.world_from_object = new_from_old_world * state.ellipsoid.world_from_object;
  const Eigen::VectorXd before = ObjectResidualsOf(cost, state);
  EXPECT_LT((ObjectResidualsOf(cost, moved) - before).norm(), 1e-8 * (1.0 + before.norm()));
}

// The same world, `scale` times as large. Its images are the same.
inline SeenEllipsoid ScaledWorld(SeenEllipsoid state, double scale) {
  state.cam_from_world.translation *= scale;
  state.ellipsoid.world_from_object.translation *= scale;
  state.ellipsoid.half_axes *= scale;
  return state;
}

// An ellipsoid that reaches the camera or is behind it has no projected ellipse.
inline void ExpectUndefinedUnlessInFront(const ceres::CostFunction& cost) {
  Eigen::VectorXd residuals(cost.num_residuals());
  for (const double z : {-2.0, 0.0, 0.3, 0.6}) {
    SeenEllipsoid state = SphereAhead();
    state.ellipsoid.world_from_object.translation = {0.1, 0.0, z};
    const ObjectBlocks blocks(state);
    EXPECT_FALSE(cost.Evaluate(blocks.Pointers().data(), residuals.data(), nullptr)) << z;
  }
  SeenEllipsoid huge = SphereAhead();
  huge.ellipsoid.half_axes.setConstant(1e300);
  const ObjectBlocks blocks(huge);
  EXPECT_FALSE(cost.Evaluate(blocks.Pointers().data(), residuals.data(), nullptr));
}

// All laws that do not depend on the values of a certain cost.
inline void ExpectObjectCostLaws(const ceres::CostFunction& cost, const SeenEllipsoid& state,
                                 RandomGeometry& random) {
  ExpectTrueObjectGradient(cost, state);
  ExpectObjectRigidInvariance(cost, state, random.Pose(2.0, 5.0));
}

}  // namespace hullslam
