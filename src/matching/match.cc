// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/match.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

namespace hullslam {
namespace {

constexpr size_t kBins = 30;

size_t RotationBin(float query_angle, float keypoint_angle) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  double change = std::fmod(static_cast<double>(query_angle) - keypoint_angle, kTurn);
  if (change < 0.0) {
    change += kTurn;
  }
  // Bins are centred on their angles, so that a change of zero lies in the middle of a bin.
  return static_cast<size_t>(std::lround(change / kTurn * kBins)) % kBins;
}

std::array<bool, kBins> FrequentBins(const std::array<int, kBins>& counts) {
  std::array<size_t, kBins> order{};
  for (size_t i = 0; i < kBins; ++i) {
    order[i] = i;
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return counts[a] > counts[b]; });
  std::array<bool, kBins> frequent{};
  for (size_t i = 0; i < 3; ++i) {
    frequent[order[i]] = 10 * counts[order[i]] >= counts[order[0]];
  }
  return frequent;
}

std::vector<float> Angles(const FrameFeatures& features) {
  std::vector<float> angles;
  angles.reserve(features.size());
  for (const Keypoint& keypoint : features.keypoints) {
    angles.push_back(keypoint.angle);
  }
  return angles;
}

}  // namespace

void KeepBestPerKeypoint(std::vector<Match>& matches) {
  const auto by_query = [](const Match& a, const Match& b) { return a.query < b.query; };
  if (!std::ranges::is_sorted(matches, by_query)) {
    std::ranges::sort(matches, by_query);
  }
  std::vector<const Match*> best;  // per keypoint
  for (const Match& match : matches) {
    best.resize(std::max<size_t>(best.size(), match.keypoint + 1));
    if (best[match.keypoint] == nullptr || match.distance < best[match.keypoint]->distance) {
      best[match.keypoint] = &match;
    }
  }
  std::vector<Match> kept;
  std::ranges::copy_if(matches, std::back_inserter(kept),
                       [&](const Match& match) { return best[match.keypoint] == &match; });
  matches = std::move(kept);
}

void KeepConsistentRotations(std::span<const float> query_angles,
                             std::span<const float> keypoint_angles, std::vector<Match>& matches) {
  std::array<int, kBins> counts{};
  const auto bin_of = [&](const Match& match) {
    return RotationBin(query_angles[match.query], keypoint_angles[match.keypoint]);
  };
  for (const Match& match : matches) {
    ++counts[bin_of(match)];
  }
  const std::array<bool, kBins> frequent = FrequentBins(counts);
  std::erase_if(matches, [&](const Match& match) { return !frequent[bin_of(match)]; });
}

void KeepConsistentRotations(const FrameFeatures& queries, const FrameFeatures& features,
                             std::vector<Match>& matches) {
  KeepConsistentRotations(Angles(queries), Angles(features), matches);
}

}  // namespace hullslam
