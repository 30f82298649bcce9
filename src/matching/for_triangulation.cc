// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/for_triangulation.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>

#include "util/function_clones.h"

namespace hullslam {
namespace {

struct Candidate {
  uint32_t keypoint = 0;
  int distance = 0;
};

// A block of keypoints with their largest allowed distances from a line. Nearly all keypoints are
// far from a given line. These are excluded for a whole block at once, in single precision; the few
// others are compared exactly afterwards.
struct Block {
  static constexpr int kSize = 16;
  using Row = Eigen::Array<float, kSize, 1>;
  Row x = Row::Zero();               // undistorted, px
  Row y = Row::Zero();               // undistorted, px
  Row reach = Row::Constant(-1.0f);  // largest distance from the line, px, with room for rounding
  std::array<uint32_t, kSize> keypoints = {};
};

// How undistortion stretches the image at each keypoint of `indices`, by keypoint: the undistorted
// offset of a raw offset. Empty without distortion.
std::vector<Eigen::Matrix2d> StretchesOf(const FrameFeatures& features,
                                         std::span<const uint32_t> indices,
                                         const PinholeCamera& camera) {
  std::vector<Eigen::Matrix2d> stretches;
  if (camera.IsDistorted()) {
    stretches.resize(features.size());
    for (const uint32_t i : indices) {
      stretches[i] =
          camera.DistortionJacobian(features.keypoints[i].undistorted.cast<double>()).inverse();
    }
  }
  return stretches;
}

std::vector<Block> MakeBlocks(const FrameFeatures& features, std::span<const uint32_t> indices,
                              std::span<const Eigen::Matrix2d> stretches, const ScaleLevels& levels,
                              double max_epipolar_chi2) {
  // Room for the rounding of the distance, which is a sum of three numbers of the size of
  // coordinates.
  constexpr float kLeastRoom = 0.01f;  // px
  constexpr float kRelativeRoom = 1e-6f;
  std::vector<Block> blocks((indices.size() + Block::kSize - 1) / Block::kSize);
  for (size_t i = 0; i < indices.size(); ++i) {
    const auto& keypoint = features.keypoints[indices[i]];
    const double sigma2 = levels.sigma2[static_cast<size_t>(keypoint.level)];
    Block& block = blocks[i / Block::kSize];
    const auto lane = static_cast<Eigen::Index>(i % Block::kSize);
    block.x[lane] = keypoint.undistorted.x();
    block.y[lane] = keypoint.undistorted.y();
    const double stretch = stretches.empty() ? 1.0 : stretches[indices[i]].norm();
    block.reach[lane] = static_cast<float>(stretch * std::sqrt(max_epipolar_chi2 * sigma2)) +
                        kLeastRoom + kRelativeRoom * keypoint.undistorted.lpNorm<1>();
    block.keypoints[i % Block::kSize] = indices[i];
  }
  return blocks;
}

// The keypoints that may be near enough to the line a x + b y + c = 0; none if a and b are zero.
void FindNear(const Eigen::Vector3d& line, std::span<const Block> blocks,
              std::vector<uint32_t>& near) {
  near.clear();
  const Eigen::Vector3f unit = (line / line.head<2>().norm()).cast<float>();
  for (const Block& block : blocks) {
    const Block::Row room =
        block.reach - (unit.x() * block.x + unit.y() * block.y + unit.z()).abs();
    if (!(room.maxCoeff() >= 0.0f)) {
      continue;
    }
    for (int i = 0; i < Block::kSize; ++i) {
      if (room[i] >= 0.0f) {
        near.push_back(block.keypoints[static_cast<size_t>(i)]);
      }
    }
  }
}

// The given keypoints of b whose descriptors are similar to the descriptor of a's keypoint.
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

// Squared distance from a pixel to the line a x + b y + c = 0, px^2; in the raw image. It
// is NaN if a and b are zero, which happens without a baseline.
double SquaredLineDistance(const Eigen::Vector3d& line, const Eigen::Vector2d& pixel,
                           const Eigen::Matrix2d* stretch) {
  const double value = line.head<2>().dot(pixel) + line.z();
  const double slope = stretch == nullptr ? line.head<2>().squaredNorm()
                                          : (stretch->transpose() * line.head<2>()).squaredNorm();
  return value * value / slope;
}

// Squared distance of two pixels, px^2; in the raw image, to first order.
double SquaredDistance(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                       const Eigen::Matrix2d* stretch) {
  const Eigen::Vector2d offset = a - b;
  return stretch == nullptr ? offset.squaredNorm() : (stretch->inverse() * offset).squaredNorm();
}

}  // namespace

std::vector<Match> MatchForTriangulation(
    const FrameFeatures& a, std::span<const uint32_t> a_indices, const FrameFeatures& b,
    std::span<const uint32_t> b_indices, const Eigen::Matrix3d& fundamental,
    const Eigen::Vector2d& epipole, const ScaleLevels& levels, const PinholeCamera& camera,
    const TriangulationSearch& search) {
  std::vector<Match> matches;
  const std::vector<Eigen::Matrix2d> stretches = StretchesOf(b, b_indices, camera);
  const std::vector<Block> blocks =
      MakeBlocks(b, b_indices, stretches, levels, search.max_epipolar_chi2);
  std::vector<uint32_t> near;
  std::vector<Candidate> similar;
  for (const uint32_t query : a_indices) {
    const Eigen::Vector2d pixel_a = a.keypoints[query].undistorted.cast<double>();
    const Eigen::Vector3d line = fundamental * pixel_a.homogeneous();
    FindNear(line, blocks, near);
    FindSimilar(a.descriptors[query], b.descriptors, near, search.max_distance, similar);
    Match best{.query = query, .distance = std::numeric_limits<int>::max()};
    for (const auto& [keypoint, distance] : similar) {
      const Eigen::Vector2d pixel_b = b.keypoints[keypoint].undistorted.cast<double>();
      const auto level = static_cast<size_t>(b.keypoints[keypoint].level);
      const bool has_depth = a.depth[query] > 0.0f || b.depth[keypoint] > 0.0f;
      const Eigen::Matrix2d* const stretch = stretches.empty() ? nullptr : &stretches[keypoint];
      const double epipole_bound =
          search.min_epipole_distance * static_cast<double>(levels.scale[level]);
      if (distance >= best.distance ||
          (!has_depth &&
           SquaredDistance(pixel_b, epipole, stretch) < epipole_bound * epipole_bound) ||
          !(SquaredLineDistance(line, pixel_b, stretch) <=
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
