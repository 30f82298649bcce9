// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "camera/point_measurement.h"
#include "estimators/similarity_error.h"
#include "support/random_geometry.h"
#include "support/synthetic_world.h"

namespace hullslam {

struct MadeSimilarityOptions {
  bool fix_scale = false;
  bool has_depth = false;
  double outliers = 0.0;  // share of the matches that are random; they are the first ones
  double noise = 0.0;     // px
};

// Two keyframes that see the same points, and matches between them.
class MadeSimilarity {
 public:
  MadeSimilarity(uint32_t seed, const MadeSimilarityOptions& options)
      : options_(options), random_(seed), generator_(seed) {
    const Rigid3 motion = random_.Pose(0.1, 0.4);
    const double scale = options.fix_scale ? 1.0 : random_.Number(0.5, 2.0);
    b_from_a_ = Sim3(scale, motion.rotation, scale * motion.translation);
  }

  std::vector<SimilarityMatch> Make(size_t count) {
    std::vector<SimilarityMatch> matches;
    for (size_t i = 0; i < count; ++i) {
      matches.push_back(MakeMatch(RandomPoint()));
      if (static_cast<double>(i) < options_.outliers * static_cast<double>(count)) {
        matches.back().point_in_b = RandomPoint();
        matches.back().measured_in_b = Measure(matches.back().point_in_b);
      }
    }
    return matches;
  }
  // The match of a point that is given in the camera frame of keyframe a.
  SimilarityMatch MakeMatch(const Eigen::Vector3d& in_a) {
    SimilarityMatch match;
    match.point_in_a = in_a;
    match.point_in_b = b_from_a_ * in_a;
    match.measured_in_a = Measure(match.point_in_a);
    match.measured_in_b = Measure(match.point_in_b);
    return match;
  }
  Eigen::Vector3d RandomPoint() {
    const double x = random_.Number(-1.2, 1.2);
    const double y = random_.Number(-1.0, 1.0);
    return {x, y, random_.Number(2.0, 6.0)};
  }

  const PinholeCamera& camera() const { return camera_; }
  const Sim3& b_from_a() const { return b_from_a_; }
  RandomGeometry& random() { return random_; }

 private:
  PointMeasurement Measure(const Eigen::Vector3d& point) {
    Eigen::Vector3d measured = ProjectRgbd(camera_, point);
    for (double& coordinate : measured) {
      coordinate += options_.noise * std::normal_distribution<double>()(generator_);
    }
    return PointMeasurement::Create(measured.head<2>(), 1.0,
                                    options_.has_depth ? std::optional(measured.z()) : std::nullopt,
                                    {.pixel_sigma = 1.0});
  }

  MadeSimilarityOptions options_;
  PinholeCamera camera_ = SyntheticSensor().camera;
  RandomGeometry random_;
  std::mt19937 generator_;
  Sim3 b_from_a_;
};

// The sum of the differences of rotation, translation and the logarithm of the scale.
inline double Distance(const Sim3& a, const Sim3& b) {
  return (a.rotation.toRotationMatrix() - b.rotation.toRotationMatrix()).norm() +
         (a.translation - b.translation).norm() + std::abs(std::log(a.scale / b.scale));
}

}  // namespace hullslam
