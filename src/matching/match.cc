// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/match.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

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
  std::sort(matches.begin(), matches.end(), [](const Match& a, const Match& b) {
    return std::tie(a.keypoint, a.distance, a.query) < std::tie(b.keypoint, b.distance, b.query);
  });
  const auto end = std::unique(matches.begin(), matches.end(), [](const Match& a, const Match& b) {
    return a.keypoint == b.keypoint;
  });
  matches.erase(end, matches.end());
  std::sort(matches.begin(), matches.end(),
            [](const Match& a, const Match& b) { return a.query < b.query; });
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
