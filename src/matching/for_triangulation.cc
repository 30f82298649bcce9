// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/for_triangulation.h"

#include <Eigen/Geometry>
#include <limits>

#include "util/function_clones.h"

namespace hullslam {
namespace {

struct Candidate {
  uint32_t keypoint = 0;
  int distance = 0;
};

// All keypoints of b whose descriptors are similar to that of the keypoint of a.
HULLSLAM_FUNCTION_CLONES
void FindSimilar(const Descriptor& query, const std::vector<Descriptor>& descriptors,
                 std::span<const uint32_t> indices, int max_distance,
                 std::vector<Candidate>& similar) {
  similar.clear();
  for (const uint32_t i : indices) {
    const int distance = HammingDistance(query, descriptors[i]);
    if (distance <= max_distance) {
      similar.push_back({i, distance});
    }
  }
}

// Squared distance from a pixel to the line a x + b y + c = 0, px^2. It is NaN if a and b are zero,
// which happens without a baseline.
double SquaredLineDistance(const Eigen::Vector3d& line, const Eigen::Vector2d& pixel) {
  const double value = line.head<2>().dot(pixel) + line.z();
  return value * value / line.head<2>().squaredNorm();
}

}  // namespace

std::vector<Match> MatchForTriangulation(
    const FrameFeatures& a, std::span<const uint32_t> a_indices, const FrameFeatures& b,
    std::span<const uint32_t> b_indices, const Eigen::Matrix3d& fundamental,
    const Eigen::Vector2d& epipole, const ScaleLevels& levels, const TriangulationSearch& search) {
  std::vector<Match> matches;
  std::vector<Candidate> similar;
  for (const uint32_t query : a_indices) {
    FindSimilar(a.descriptors[query], b.descriptors, b_indices, search.max_distance, similar);
    const Eigen::Vector2d pixel_a = a.keypoints[query].undistorted.cast<double>();
    const Eigen::Vector3d line = fundamental * pixel_a.homogeneous();
    Match best{.query = query, .distance = std::numeric_limits<int>::max()};
    for (const auto& [keypoint, distance] : similar) {
      const Eigen::Vector2d pixel_b = b.keypoints[keypoint].undistorted.cast<double>();
      const auto level = static_cast<size_t>(b.keypoints[keypoint].level);
      const bool has_depth = a.right_u[query] >= 0.0f || b.right_u[keypoint] >= 0.0f;
      const double epipole_bound =
          search.min_epipole_distance * static_cast<double>(levels.scale[level]);
      if (distance >= best.distance ||
          (!has_depth && (pixel_b - epipole).squaredNorm() < epipole_bound * epipole_bound) ||
          !(SquaredLineDistance(line, pixel_b) <=
            search.max_epipolar_chi2 * static_cast<double>(levels.sigma2[level]))) {
        continue;
      }
      best.keypoint = keypoint;
      best.distance = distance;
    }
    if (best.distance <= search.max_distance) {
      matches.push_back(best);
    }
  }
  KeepBestPerKeypoint(matches);
  return matches;
}

}  // namespace hullslam
