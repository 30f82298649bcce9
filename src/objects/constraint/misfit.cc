// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/constraint/misfit.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "geometry/polygon.h"

namespace hullslam {

double RawShare(const PinholeCamera& camera, const Eigen::Vector2d& undistorted,
                const Eigen::Vector2d& normal) {
  const Eigen::Matrix2d jacobian = camera.DistortionJacobian(undistorted);
  return 1.0 / (jacobian.inverse().transpose() * normal).norm();
}

std::vector<SilhouetteLine> ScaleToRaw(const PinholeCamera& camera, const Detection& detection,
                                       std::span<const SilhouetteLine> lines) {
  std::vector<SilhouetteLine> scaled(lines.begin(), lines.end());
  if (!camera.IsDistorted() || detection.hull.empty()) {
    return scaled;
  }
  for (SilhouetteLine& line : scaled) {
    const Eigen::Vector2d normal = line.line.normal;
    const auto touching = std::max_element(
        detection.hull.begin(), detection.hull.end(),
        [&](const auto& a, const auto& b) { return normal.dot(a) < normal.dot(b); });
    const double share = RawShare(camera, *touching, normal);
    line.line.normal *= share;
    line.line.offset *= share;
  }
  return scaled;
}

namespace {

constexpr double kReach = 3.0;  // in widths; samples farther away have nearly no weight
// Least sum of weights: that of one sample at the normal, or of several samples near it.
constexpr double kMinWeight = 1.0;
constexpr double kNoSlope = 0.3;           // weight of the prior that the slope is 0
constexpr double kMinContactDepth = 1e-3;  // least depth of the contact point, in units of the map

}  // namespace

std::optional<TangentPlane> PlaneOfLine(const PinholeCamera& camera, const Rigid3& cam_from_world,
                                        const Ellipsoid& ellipsoid, const Line2& line) {
  const Rigid3 cam_from_object = cam_from_world * ellipsoid.world_from_object;
  const Eigen::Vector3d back_projected = camera.Matrix().transpose() * line.Homogeneous();
  const double scale = back_projected.norm();
  const Eigen::Vector3d normal_in_cam = back_projected / scale;
  TangentPlane plane;
  plane.normal = cam_from_object.rotation.conjugate() * normal_in_cam;
  const Eigen::Vector3d stretched = ellipsoid.half_axes.cwiseProduct(plane.normal);
  const double support = stretched.norm();
  plane.excess = -normal_in_cam.dot(cam_from_object.translation) - support;
  const Eigen::Vector3d contact = ellipsoid.half_axes.cwiseProduct(stretched) / support;
  const Eigen::Vector3d contact_in_cam = cam_from_object * contact;
  const double depth = contact_in_cam.z();
  if (depth < kMinContactDepth) {
    return std::nullopt;
  }
  plane.pixels_per_metre = scale / depth;
  plane.raw_per_metre =
      plane.pixels_per_metre * RawShare(camera, camera.Project(contact_in_cam), line.normal);
  return plane;
}

std::vector<MisfitSample> MeasureMisfit(const PinholeCamera& camera, const Ellipsoid& ellipsoid,
                                        std::span<const ResolvedObservation> observations) {
  std::vector<MisfitSample> samples;
  samples.reserve(std::accumulate(observations.begin(), observations.end(), size_t{0},
                                  [](size_t sum, const ResolvedObservation& observation) {
                                    return sum + observation.detection->lines.size();
                                  }));
  for (const ResolvedObservation& observation : observations) {
    for (const SilhouetteLine& line : observation.detection->lines) {
      if (line.is_one_sided) {
        continue;
      }
      if (const auto plane =
              PlaneOfLine(camera, observation.cam_from_world, ellipsoid, line.line)) {
        samples.push_back(
            {plane->normal.cast<float>(), static_cast<float>(plane->excess), observation.keyframe});
      }
    }
  }
  return samples;
}

std::optional<double> PredictExcess(std::span<const MisfitSample> samples,
                                    const Eigen::Vector3d& normal, KeyframeId left_out,
                                    const MisfitOptions& options) {
  const double width = options.width * std::numbers::pi / 180.0;
  // Axes of the tangent plane of the unit sphere at the normal.
  const Eigen::Vector3d across = normal.unitOrthogonal();
  const Eigen::Vector3d along = normal.cross(across);
  const double min_cosine = std::cos(kReach * width);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  for (const MisfitSample& sample : samples) {
    const Eigen::Vector3d sampled = sample.normal.cast<double>();
    const double cosine = sampled.dot(normal);
    if (cosine < min_cosine || sample.keyframe == left_out) {
      continue;
    }
    const Eigen::Vector3d basis(1.0, across.dot(sampled) / width, along.dot(sampled) / width);
    const double weight = std::exp(-(1.0 - cosine) / (width * width));
    information += weight * basis * basis.transpose();
    right_side += weight * static_cast<double>(sample.excess) * basis;
  }
  if (information(0, 0) < kMinWeight) {
    return std::nullopt;
  }
  // The prior prevents extrapolation if all samples are on one side.
  information(1, 1) += kNoSlope;
  information(2, 2) += kNoSlope;
  return information.ldlt().solve(right_side).x();
}

std::vector<SilhouetteLine> CompensateLines(const PinholeCamera& camera,
                                            const Rigid3& cam_from_world,
                                            const ObjectLandmark& object,
                                            std::span<const SilhouetteLine> lines,
                                            KeyframeId left_out, std::vector<uint8_t>& known,
                                            const MisfitOptions& options) {
  std::vector<SilhouetteLine> moved(lines.begin(), lines.end());
  known.assign(lines.size(), 0);
  for (size_t i = 0; i < moved.size(); ++i) {
    const auto plane = PlaneOfLine(camera, cam_from_world, object.ellipsoid, moved[i].line);
    const auto excess = plane
                            ? PredictExcess(object.misfit_samples, plane->normal, left_out, options)
                            : std::nullopt;
    if (excess) {
      moved[i].line.offset += *excess * plane->pixels_per_metre;
      known[i] = 1;
    }
  }
  return moved;
}

MisfitSpread MeasureSpread(const PinholeCamera& camera, const ObjectLandmark& object,
                           std::span<const ResolvedObservation> observations,
                           const MisfitOptions& options) {
  double plain = 0.0;
  double compensated = 0.0;
  size_t count = 0;
  for (const ResolvedObservation& observation : observations) {
    for (const SilhouetteLine& line : observation.detection->lines) {
      const auto plane = line.is_one_sided ? std::nullopt
                                           : PlaneOfLine(camera, observation.cam_from_world,
                                                         object.ellipsoid, line.line);
      if (!plane) {
        continue;
      }
      const double excess = plane->excess * plane->raw_per_metre;
      const double predicted =
          PredictExcess(object.misfit_samples, plane->normal, observation.keyframe, options)
              .value_or(0.0) *
          plane->raw_per_metre;
      plain += excess * excess;
      compensated += (excess - predicted) * (excess - predicted);
      ++count;
    }
  }
  const auto mean = static_cast<double>(std::max<size_t>(1, count));
  return {std::sqrt(plain / mean), std::sqrt(compensated / mean)};
}

double RelativeMisfit(const PinholeCamera& camera, const Ellipsoid& ellipsoid,
                      std::span<const ResolvedObservation> observations) {
  double squared_misfit = 0.0;
  double squared_size = 0.0;  // sum over the lines of the squared size of their mask
  for (const ResolvedObservation& observation : observations) {
    for (const SilhouetteLine& line : observation.detection->lines) {
      const auto plane =
          line.is_one_sided ? std::nullopt
                            : PlaneOfLine(camera, observation.cam_from_world, ellipsoid, line.line);
      if (plane) {
        const double pixels = plane->excess * plane->pixels_per_metre;
        squared_misfit += pixels * pixels;
        squared_size += SignedArea(observation.detection->hull);
      }
    }
  }
  return squared_size > 0.0 ? std::sqrt(squared_misfit / squared_size) : 0.0;
}

}  // namespace hullslam
