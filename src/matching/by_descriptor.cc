// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/by_descriptor.h"

#include "util/function_clones.h"

namespace hullslam {
namespace {

HULLSLAM_FUNCTION_CLONES
TwoBest FindTwoBest(const Descriptor& query, std::span<const Descriptor> descriptors) {
  TwoBest result;
  for (uint32_t i = 0; i < descriptors.size(); ++i) {
    result.Add(i, HammingDistance(query, descriptors[i]));
  }
  return result;
}

}  // namespace

std::vector<Match> MatchByDescriptor(const FrameFeatures& queries,
                                     std::span<const uint32_t> indices,
                                     const FrameFeatures& features,
                                     const DescriptorSearch& search) {
  std::vector<Match> matches;
  for (const uint32_t query : indices) {
    const TwoBest found = FindTwoBest(queries.descriptors[query], features.descriptors);
    if (found.best <= search.max_distance && found.best < search.max_ratio * found.second) {
      matches.push_back({query, found.keypoint, found.best});
    }
  }
  KeepBestPerKeypoint(matches);
  KeepConsistentRotations(queries, features, matches);
  return matches;
}

}  // namespace hullslam
