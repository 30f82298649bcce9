// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/camera_model.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string_view>

#include "camera/wide_lens.h"

namespace hullslam {
namespace {

using Kind = CameraParameter::Kind;

// The step of a coefficient of the lens: by numbers, since each lens has others.
double StepOfCoefficient(const CameraModel& model, double PinholeCamera::*field) {
  const PinholeCamera& camera = model.camera;
  constexpr double kSmall = 1e-4;
  CameraModel moved = model;
  moved.camera.*field += kSmall;
  // 0.9 of the way to a corner, where features still are.
  const Eigen::Vector2d corner(0.05 * camera.width, 0.05 * camera.height);
  const Eigen::Vector2d undistorted = camera.Undistort(corner);
  const double change = (moved.camera.Distort(undistorted) - camera.Distort(undistorted)).norm();
  return kSmall / std::max(change, 1e-9);
}

void AddDepthPose(const PinholeCamera& camera, double speed,
                  std::vector<CameraParameter>& parameters) {
  if (speed > 0.0) {
    parameters.push_back(
        {.kind = Kind::kDepthTime, .name = "depth_time", .unit = "s", .step = 1.0 / speed});
  }
  constexpr double kUsualDepth = 1.5;  // m
  const double turn = 1.0 / camera.fx;
  for (int i = 0; i < 6; ++i) {
    const bool is_turn = i < 3;
    parameters.push_back(
        {.kind = Kind::kDepthPose,
         .index = i,
         .name = fmt::format("depth_{}_{}", is_turn ? "turn" : "shift", "xyz"[i % 3]),
         .unit = is_turn ? "rad" : "m",
         .step = is_turn ? turn : turn * kUsualDepth});
  }
}

}  // namespace

double CameraModel::ExposureOf(const Eigen::Vector2d& raw) const {
  const double share = readout_direction == ReadoutDirection::kRows ? raw.y() / camera.height
                                                                    : raw.x() / camera.width;
  return readout_time * (share - 0.5);
}

Eigen::Vector3d MovedPoint(const Eigen::Vector3d& point, const PointVelocity& velocity,
                           double seconds) {
  const Eigen::Vector3d speed = velocity.angular.cross(point) + velocity.linear;
  return point + seconds * speed + 0.5 * seconds * seconds * velocity.angular.cross(speed);
}

Eigen::Vector2d CameraModel::Project(const Eigen::Vector3d& point, const PointVelocity& velocity,
                                     double seconds) const {
  return camera.Distort(camera.Project(MovedPoint(point, velocity, seconds)));
}

double CameraParameter::ValueIn(const CameraModel& model) const {
  switch (kind) {
    case Kind::kFocalLength:
      return model.camera.fx;
    case Kind::kField:
      return model.camera.*field;
    case Kind::kReadout:
      return model.readout_time;
    case Kind::kDisparityOffset:
      return model.disparity_offset;
    case Kind::kDepthScale:
      return model.depth_scale;
    case Kind::kDepthTime:
      return model.depth_time;
    case Kind::kDepthPose:
      return model.depth_pose[index];
  }
  return 0.0;
}

double CameraParameter::DeviationIn(const CameraModel& model) const {
  return prior_steps > 0.0 ? (ValueIn(model) - expected) / (step * prior_steps) : 0.0;
}

void CameraParameter::Move(double steps, CameraModel& model) const {
  switch (kind) {
    case Kind::kFocalLength: {
      // In log f, so that it stays positive.
      const double factor = std::exp(steps * step / model.camera.fx);
      model.camera.fx *= factor;
      model.camera.fy *= factor;
      model.camera.bf *= model.is_pair ? factor : 1.0;
      return;
    }
    case Kind::kField:
      model.camera.*field += steps * step;
      return;
    case Kind::kReadout:
      model.readout_time += steps * step;
      return;
    case Kind::kDisparityOffset:
      model.disparity_offset += steps * step;
      return;
    case Kind::kDepthScale:
      model.depth_scale *= std::exp(steps * step);
      return;
    case Kind::kDepthTime:
      model.depth_time += steps * step;
      return;
    case Kind::kDepthPose:
      model.depth_pose[index] += steps * step;
      return;
  }
}

std::vector<CameraParameter> ParametersOf(const CameraModel& model, const CalibrationChoice& choice,
                                          bool has_depth, double speed) {
  const PinholeCamera& camera = model.camera;
  std::vector<CameraParameter> parameters;
  if (choice.focal_length) {
    const double half_diagonal = 0.5 * std::hypot(camera.width, camera.height);
    parameters.push_back({.kind = Kind::kFocalLength,
                          .field = nullptr,
                          .name = "fx",
                          .unit = "px",
                          .step = camera.fx / half_diagonal});
  }
  const auto add = [&](std::string_view name, double PinholeCamera::*field, const char* unit,
                       double step) {
    parameters.push_back({.kind = Kind::kField,
                          .field = field,
                          .name = std::string(name),
                          .unit = unit,
                          .step = step});
  };
  if (choice.principal_point) {
    add("cx", &PinholeCamera::cx, "px", 1.0);
    add("cy", &PinholeCamera::cy, "px", 1.0);
  }
  if (choice.distortion) {
    for (const LensCoefficient& one : CoefficientsOf(camera.lens)) {
      const bool is_basic =
          one.name == "k1" || one.name == "k2" || one.name == "p1" || one.name == "p2";
      if (is_basic || FindWideModel(camera.lens) != nullptr || camera.*one.field != 0.0) {
        add(one.name, one.field, "", StepOfCoefficient(model, one.field));
      }
    }
  }
  if (choice.readout && speed > 0.0) {
    // At the border a row is exposed half of the readout before or after the middle.
    parameters.push_back({.kind = Kind::kReadout,
                          .field = nullptr,
                          .name = "readout_time",
                          .unit = "s",
                          .step = 2.0 / speed});
  }
  if (choice.disparity && has_depth) {
    parameters.push_back({.kind = Kind::kDisparityOffset,
                          .field = nullptr,
                          .name = "disparity_offset",
                          .unit = "px",
                          .step = 1.0});
  }
  if (has_depth && !model.is_pair) {
    parameters.push_back({.kind = Kind::kDepthScale,
                          .field = nullptr,
                          .name = kDepthScaleName,
                          .unit = "",
                          .step = kDepthScaleSigma,
                          .prior_steps = 1.0,
                          .expected = 1.0});
  }
  if (choice.depth_pose && has_depth && !model.is_pair) {
    AddDepthPose(camera, speed, parameters);
  }
  return parameters;
}

void ExpectNear(const CameraModel& guess, std::vector<CameraParameter>& parameters) {
  const auto sigma_of = [&](const CameraParameter& parameter) {
    switch (parameter.kind) {
      case Kind::kFocalLength:
        return 0.25 * guess.camera.fx;
      case Kind::kReadout:
        return 0.06;
      case Kind::kDisparityOffset:
        return 2.0;
      case Kind::kDepthScale:
        return kDepthScaleSigma;
      case Kind::kDepthTime:
        return 0.06;
      case Kind::kDepthPose:
        return 0.03;
      case Kind::kField:
        break;
    }
    return !parameter.IsCoefficient() ? 0.02 * guess.camera.width
                                      : (parameter.IsCentring() ? 3.0 : 60.0) * parameter.step;
  };
  for (CameraParameter& parameter : parameters) {
    parameter.prior_steps = sigma_of(parameter) / parameter.step;
    parameter.expected = parameter.ValueIn(guess);
  }
}

}  // namespace hullslam
