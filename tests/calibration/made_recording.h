// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "calibration/camera_problem.h"
#include "hullslam/geometry/rigid3.h"
#include "support/fisheye_camera.h"

namespace hullslam {

// How a camera moves: amplitudes of slow sums of sines.
struct MadeMotion {
  Eigen::Vector3d way = {0.5, 0.3, 0.4};   // m, in x (right), y (down), z (forward)
  Eigen::Vector3d turn = {0.3, 0.4, 0.3};  // rad, about x, y, z
};

inline const MadeMotion kHandHeld;
inline const MadeMotion kRollOnly{.way = Eigen::Vector3d::Zero(), .turn = {0.0, 0.0, 0.5}};
inline const MadeMotion kPan{.way = Eigen::Vector3d::Zero(), .turn = {0.3, 0.4, 0.0}};
inline const MadeMotion kShiftAndRoll{.way = {0.5, 0.3, 0.4}, .turn = {0.0, 0.0, 0.5}};
inline const MadeMotion kAhead{.way = {0.0, 0.0, 1.0}, .turn = Eigen::Vector3d::Zero()};
inline const MadeMotion kAlongPlane{.way = {0.5, 0.3, 0.0}, .turn = Eigen::Vector3d::Zero()};
inline const MadeMotion kNone{.way = Eigen::Vector3d::Zero(), .turn = Eigen::Vector3d::Zero()};

struct MadeRecordingOptions {
  MadeMotion motion;
  CameraModel truth;
  bool has_depth = false;
  bool is_plane = false;         // all points lie in a plane across the view
  double pixel_noise = 0.4;      // px
  double disparity_noise = 0.3;  // px
  size_t views = 60;
  size_t points = 500;
  double interval = 0.1;  // s
  uint32_t seed = 0;
};

inline CameraModel MadeCamera() {
  CameraModel model;
  model.camera.fx = model.camera.fy = 520.0;
  model.camera.cx = 318.0;
  model.camera.cy = 243.0;
  model.camera.k1 = -0.1;
  model.camera.k2 = 0.05;
  model.camera.bf = 40.0;
  return model;
}

// 40 images and 300 points of a rolling shutter of 20 ms.
inline MadeRecordingOptions ShortRecording(const MadeMotion& motion, bool has_depth,
                                           uint32_t seed) {
  MadeRecordingOptions options{.motion = motion, .truth = MadeCamera(), .has_depth = has_depth};
  options.truth.readout_time = 0.02;
  options.views = 40;
  options.points = 300;
  options.seed = seed;
  return options;
}

// The lenses of a rolling shutter that moves.
inline std::vector<CameraModel> MadeCameraModels() {
  std::vector<CameraModel> models;
  for (const PinholeCamera& camera :
       {MadeCamera().camera, FisheyeCamera(), DoubleSphereCamera(), ExtendedUnifiedCamera()}) {
    CameraModel& model = models.emplace_back();
    model.camera = camera;
    model.camera.bf = 40.0;
    model.readout_time = 0.02;
    model.disparity_offset = 0.3;
    model.depth_time = -0.012;
    model.depth_pose << 0.01, -0.008, 0.004, -0.01, 0.006, 0.003;
    model.depth_scale = 1.01;
  }
  return models;
}

// Exact observations of made points with noise; the motion is smooth, so the velocities are exact.
class MadeRecording {
 public:
  explicit MadeRecording(const MadeRecordingOptions& options)
      : options_(options), random_(options.seed + 1) {
    for (Eigen::Vector3d& phase : phases_) {
      phase = Eigen::Vector3d(Uniform(0.0, 6.28), Uniform(0.0, 6.28), Uniform(0.0, 6.28));
    }
    problem_.has_depth = options.has_depth;
    problem_.disparity_sigma = options.disparity_noise;
    for (size_t i = 0; i < options.views; ++i) {
      const double time = options.interval * static_cast<double>(i);
      problem_.views.push_back({time, CamFromWorld(time), VelocityAt(time)});
    }
    // Points lie in all directions that the camera may look to.
    while (problem_.points.size() < options.points) {
      AddPoint(
          {Uniform(-6.0, 6.0), Uniform(-4.0, 4.0), options.is_plane ? 3.0 : Uniform(1.5, 5.0)});
    }
  }

  const CalibrationProblem& problem() const { return problem_; }

  Rigid3 CamFromWorld(double time) const {
    Eigen::Vector3d angle;
    Eigen::Vector3d position;
    for (int i = 0; i < 3; ++i) {
      constexpr double kSlow = 1.1;  // rad/s
      angle[i] = options_.motion.turn[i] * std::sin(kSlow * time * (1.0 + 0.3 * i) + phases_[0][i]);
      position[i] =
          options_.motion.way[i] * std::sin(kSlow * time * (1.3 - 0.25 * i) + phases_[1][i]);
    }
    return Inverse(Rigid3(ExpSo3(angle), position));
  }

 private:
  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  PointVelocity VelocityAt(double time) const {
    constexpr double kStep = 1e-4;  // s
    return MeanVelocity(CamFromWorld(time + kStep) * Inverse(CamFromWorld(time - kStep)),
                        2.0 * kStep);
  }

  // Of the surface, at the pixel of its point when the depth image is taken, and from there.
  double DisparityAt(const CalibrationObservation& seen, const Eigen::Vector3d& in_camera,
                     const Eigen::Vector3d& point) const {
    const CameraModel& truth = options_.truth;
    const double time = problem_.views[seen.view].timestamp + truth.ExposureOf(seen.raw) +
                        seen.depth_delay + truth.depth_time;
    const Rigid3 depth_from_colour(ExpSo3(truth.depth_pose.head<3>()), truth.depth_pose.tail<3>());
    const Eigen::Vector3d deep = depth_from_colour * (CamFromWorld(time) * point);
    return truth.camera.bf / deep.z() + truth.disparity_offset +
           seen.slope.dot(truth.camera.Project(in_camera) - truth.camera.Project(deep));
  }

  void AddPoint(const Eigen::Vector3d& point) {
    std::vector<CalibrationObservation> seen;
    const CameraModel& truth = options_.truth;
    for (uint32_t i = 0; i < problem_.views.size(); ++i) {
      Eigen::Vector3d in_camera = problem_.views[i].cam_from_world * point;
      // Farther from the axis the lens may fold.
      if (in_camera.z() < 0.3 || in_camera.head<2>().norm() > 0.9 * in_camera.z()) {
        continue;
      }
      Eigen::Vector2d raw = truth.camera.Distort(truth.camera.Project(in_camera));
      for (int k = 0; k < 8; ++k) {
        in_camera = CamFromWorld(problem_.views[i].timestamp + truth.ExposureOf(raw)) * point;
        raw = truth.camera.Distort(truth.camera.Project(in_camera));
      }
      if (!truth.camera.SeesRaw(raw)) {
        continue;
      }
      CalibrationObservation one{.view = i, .raw = raw, .sigma = options_.pixel_noise};
      one.raw.x() += options_.pixel_noise * noise_(random_);
      one.raw.y() += options_.pixel_noise * noise_(random_);
      if (options_.has_depth) {
        one.depth_delay = Uniform(-0.01, 0.01);
        one.slope = {Uniform(-0.05, 0.05), Uniform(-0.05, 0.05)};
        one.disparity =
            DisparityAt(one, in_camera, point) + options_.disparity_noise * noise_(random_);
      }
      seen.push_back(one);
    }
    if (seen.size() >= 4) {
      problem_.points.push_back(point);
      problem_.observations.push_back(std::move(seen));
    }
  }

  MadeRecordingOptions options_;
  std::mt19937 random_;
  std::normal_distribution<double> noise_;
  std::array<Eigen::Vector3d, 2> phases_;
  CalibrationProblem problem_;
};

}  // namespace hullslam
