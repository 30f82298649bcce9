// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "calibration/camera_model.h"
#include "calibration/raw_residual.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// An image of a calibration.
struct CalibrationView {
  double timestamp = 0.0;  // s
  Rigid3 cam_from_world;   // at the exposure of the middle
  PointVelocity velocity;  // at this time
  uint32_t recording = 0;  // those of one camera have worlds of their own
};

// The images and points from which a camera is calibrated. Without disparities the unit of length
// is free.
struct CalibrationProblem {
  std::vector<CalibrationView> views;  // by recording and time
  std::vector<Eigen::Vector3d> points;
  std::vector<std::vector<CalibrationObservation>> observations;  // of each point
  double disparity_sigma = 1.0;                                   // px
  bool has_depth = false;
  // CameraModel::depth_pose of the run, which has taken it out of the depths already.
  Eigen::Matrix<double, 6, 1> known_depth_pose = Eigen::Matrix<double, 6, 1>::Zero();

  size_t CountObservations() const;
  // Adds another recording of the same camera.
  void Append(const CalibrationProblem& other);
};

// The median speed of the points in the images of a problem, px/s; 0 without velocities.
double MedianSpeed(const CalibrationProblem& problem, const CameraModel& model);

// The normal equations of all parameters of a calibration but the points, which are eliminated as
// in optim/eliminated_points.h: six for each view (Retract), then those of the camera, in steps.
struct ReducedSystem {
  Eigen::MatrixXd hessian;  // lower half
  Eigen::VectorXd gradient;
  double weighted_chi2 = 0.0;  // the sum of the squared residuals, weighted by the loss
  double weight = 0.0;         // the sum of the weights of all residuals
};

// Bundle adjustment in raw pixels: poses, points and the numbers of the camera. The residuals are
// those of raw_residual.h, with Cauchy's loss on their squared norm. The first view of each
// recording does not move. Without depth the distance of the view that is farthest from it is kept.
class CameraAdjustment {
 public:
  CameraAdjustment(CalibrationProblem problem, CameraModel model,
                   std::vector<CameraParameter> parameters);

  struct Options {
    int max_iterations = 40;
    double tolerance = 1e-7;  // relative change of the cost at which it ends
  };
  // Minimises the cost. Drops observations much nearer than the others, and points that too few
  // views see then.
  void Solve(const Options& options);

  const CalibrationProblem& problem() const { return problem_; }
  const CameraModel& model() const { return model_; }
  std::span<const CameraParameter> parameters() const { return parameters_; }
  double cost() const { return cost_; }
  // What the residuals tell about the camera at the minimum.
  struct Minimum {
    // The inverse covariance of the camera's parameters in steps, with poses and points eliminated;
    // for sigmas that are right.
    Eigen::MatrixXd information;
    double variance_factor = 1.0;  // mean squared residual of the inliers: 1 if sigmas are right
  };
  Minimum AtMinimum() const;
  // The step of the camera's parameters to the minimum without the views that are marked, to first
  // order. There is one mark per view.
  Eigen::VectorXd StepWithout(const std::vector<uint8_t>& is_left_out) const;
  // The median length of the raw reprojection errors, px.
  double MedianError() const;
  // The standard deviation of disparities that their errors have, px; that of the problem without
  // depth.
  double DisparitySigma() const;

 private:
  struct PointSystem;
  struct Reduction;

  PointSystem SystemOf(size_t point, const Reduction& reduction, ReducedSystem& sum) const;
  PointSystem Eliminate(size_t index, const Reduction& reduction, double damping,
                        ReducedSystem& sum) const;
  ReducedSystem Reduce(double damping, const std::vector<uint8_t>& is_left_out,
                       std::vector<PointSystem>* points) const;
  void FixFrame(const std::vector<uint8_t>& is_left_out, Eigen::MatrixXd& hessian) const;
  Eigen::MatrixXd CameraInformation(const ReducedSystem& system, Eigen::VectorXd* gradient) const;
  Eigen::Vector3d ResidualOf(const CalibrationObservation& seen,
                             const Eigen::Vector3d& in_camera) const;
  void DropPointsInCameras();
  void Minimise(const Options& options);
  // The median of a number that is computed from each observation and its point in the camera
  // frame.
  template <typename Measure>
  double MedianOf(const Measure& measure) const;
  double Cost(const CameraModel& model, std::span<const CalibrationView> views,
              std::span<const Eigen::Vector3d> points) const;
  Eigen::Index camera_row() const { return 6 * static_cast<Eigen::Index>(problem_.views.size()); }

  CalibrationProblem problem_;
  RawResidual residual_;
  CameraModel model_;
  std::vector<CameraParameter> parameters_;
  double loss_scale_;  // sigmas
  double cost_ = 0.0;
};

}  // namespace hullslam
