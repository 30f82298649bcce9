// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "hullslam/features/feature_grid.h"

namespace hullslam {

struct Match {
  uint32_t query = 0;     // index of the query
  uint32_t keypoint = 0;  // index of the keypoint that was found
  int distance = 0;       // Hamming, 0 to 256
};

// The candidate nearest to a descriptor, and the distance of the second nearest one.
struct TwoBest {
  int best = std::numeric_limits<int>::max();
  int second = std::numeric_limits<int>::max();
  uint32_t keypoint = 0;

  void Add(uint32_t candidate, int distance) {
    if (distance < best) {
      second = best;
      best = distance;
      keypoint = candidate;
    } else if (distance < second) {
      second = distance;
    }
  }
};

// Keeps for each keypoint the match of least distance; ties go to the lowest query. Afterwards
// `matches` is sorted by query.
void KeepBestPerKeypoint(std::vector<Match>& matches);

// Keeps the matches whose change of keypoint angle is among the three most frequent changes, in 30
// bins of 12 degrees (Mur-Artal and Tardos 2017). The second and third bins only count if they
// contain at least a tenth of the matches of the first. Angles are in radians, indexed by query and
// by keypoint.
void KeepConsistentRotations(std::span<const float> query_angles,
                             std::span<const float> keypoint_angles, std::vector<Match>& matches);
// The same for queries that are the keypoints of an image.
void KeepConsistentRotations(const FrameFeatures& queries, const FrameFeatures& features,
                             std::vector<Match>& matches);

}  // namespace hullslam
