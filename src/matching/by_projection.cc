// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/by_projection.h"

#include <cmath>
#include <limits>

#include "hullslam/util/check.h"
#include "util/function_clones.h"

namespace hullslam {
namespace {

struct Best {
  int distance = std::numeric_limits<int>::max();
  int level = -1;
  int second_distance = std::numeric_limits<int>::max();
  int second_level = -1;
  uint32_t keypoint = 0;
};

bool IsDepthOff(const Projection& projection, float depth) {
  return depth > 0.0f && (depth < projection.nearest || depth > projection.farthest);
}

HULLSLAM_FUNCTION_CLONES
Best FindBest(const FrameFeatures& features, const Projection& projection,
              std::span<const uint8_t> taken, std::span<const uint32_t> candidates) {
  Best best;
  for (const uint32_t i : candidates) {
    if ((!taken.empty() && taken[i] != 0) || IsDepthOff(projection, features.depth[i])) {
      continue;
    }
    const int distance = HammingDistance(projection.descriptor, features.descriptors[i]);
    if (distance < best.distance) {
      best.second_distance = best.distance;
      best.second_level = best.level;
      best.distance = distance;
      best.level = features.keypoints[i].level;
      best.keypoint = i;
    } else if (distance < best.second_distance) {
      best.second_distance = distance;
      best.second_level = features.keypoints[i].level;
    }
  }
  return best;
}

bool IsAmbiguous(const Best& best, double max_ratio) {
  return best.level == best.second_level && max_ratio < 1.0 &&
         best.distance > max_ratio * best.second_distance;
}

void KeepConsistent(const FrameFeatures& features, std::span<const Projection> projections,
                    std::vector<Match>& matches) {
  std::vector<float> query_angles(projections.size());
  for (size_t i = 0; i < projections.size(); ++i) {
    query_angles[i] = projections[i].angle;
  }
  std::vector<float> keypoint_angles(features.size());
  for (size_t i = 0; i < features.size(); ++i) {
    keypoint_angles[i] = features.keypoints[i].angle;
  }
  KeepConsistentRotations(query_angles, keypoint_angles, matches);
}

}  // namespace

void Projection::ExpectDepth(double z, double bf) {
  const double disparity = bf / z;
  nearest = static_cast<float>(bf / (disparity + radius));
  farthest = disparity > radius ? static_cast<float>(bf / (disparity - radius))
                                : std::numeric_limits<float>::infinity();
}

std::vector<Match> MatchByProjection(const FrameFeatures& features,
                                     std::span<const Projection> projections,
                                     std::span<const uint8_t> taken,
                                     const ProjectionSearch& search) {
  Check(taken.empty() || taken.size() == features.size(), "`taken` needs one entry per keypoint");
  std::vector<Match> matches;
  GridSearch grid(features.grid, features.keypoints);
  std::vector<uint32_t> allowed;
  for (uint32_t query = 0; query < projections.size(); ++query) {
    const Projection& projection = projections[query];
    std::span<const uint32_t> candidates = grid.FindNear(
        projection.pixel, projection.radius, projection.min_level, projection.max_level);
    if (search.may_match) {
      allowed.assign(candidates.begin(), candidates.end());
      std::erase_if(allowed, [&](uint32_t keypoint) { return !search.may_match(query, keypoint); });
      candidates = allowed;
    }
    const Best best = FindBest(features, projection, taken, candidates);
    if (best.distance <= search.max_distance && !IsAmbiguous(best, search.max_ratio)) {
      matches.push_back({query, best.keypoint, best.distance});
    }
  }
  KeepBestPerKeypoint(matches);
  if (search.compare_rotation) {
    KeepConsistent(features, projections, matches);
  }
  return matches;
}

}  // namespace hullslam
