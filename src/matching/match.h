// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace hullslam {

struct Match {
  uint32_t query = 0;     // index into what is searched for
  uint32_t keypoint = 0;  // index into what is searched in
  int distance = 0;       // Hamming, 0 to 256
};

// Keeps for every keypoint the match of least distance, of equal ones that of the lowest query.
// `matches` comes back by increasing query.
void KeepBestPerKeypoint(std::vector<Match>& matches);

// Keeps the matches whose change of keypoint angle agrees with the three most frequent changes, in
// 30 bins of 12 degrees (Mur-Artal and Tardos 2017); of the second and third bin only where they
// hold at least a tenth of the first. Angles are in radians, indexed by query and keypoint.
void KeepConsistentRotations(std::span<const float> query_angles,
                             std::span<const float> keypoint_angles, std::vector<Match>& matches);

}  // namespace hullslam
