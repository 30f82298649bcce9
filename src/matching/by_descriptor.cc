// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/by_descriptor.h"

#include <algorithm>
#include <tuple>

#include "hullslam/util/check.h"
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

struct NodeKeypoint {
  VocabularyNodeId node;
  uint32_t keypoint = 0;
};

// The keypoints with a node, sorted by node and then by index.
std::vector<NodeKeypoint> SortByNode(std::span<const VocabularyNodeId> nodes) {
  std::vector<NodeKeypoint> sorted;
  sorted.reserve(nodes.size());
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].IsValid()) {
      sorted.push_back({nodes[i], i});
    }
  }
  std::sort(sorted.begin(), sorted.end(), [](const NodeKeypoint& a, const NodeKeypoint& b) {
    return std::tie(a.node, a.keypoint) < std::tie(b.node, b.keypoint);
  });
  return sorted;
}

// The keypoints from the front of `sorted` that have the node of the first one.
std::span<const NodeKeypoint> FirstNode(std::span<const NodeKeypoint> sorted) {
  const auto end = std::find_if(sorted.begin(), sorted.end(), [&](const NodeKeypoint& keypoint) {
    return keypoint.node != sorted.front().node;
  });
  return {sorted.begin(), end};
}

HULLSLAM_FUNCTION_CLONES
TwoBest FindTwoBest(const Descriptor& query, std::span<const uint32_t> candidates,
                    const std::vector<Descriptor>& descriptors) {
  TwoBest result;
  for (const uint32_t candidate : candidates) {
    result.Add(candidate, HammingDistance(query, descriptors[candidate]));
  }
  return result;
}

// Matches the keypoints of one node.
void MatchNode(const FrameFeatures& queries, std::span<const NodeKeypoint> query_keypoints,
               const FrameFeatures& features, std::span<const NodeKeypoint> keypoints,
               const WordSearch& search, std::vector<Match>& matches) {
  std::vector<uint32_t> candidates;
  for (const NodeKeypoint& query : query_keypoints) {
    candidates.clear();
    for (const NodeKeypoint& other : keypoints) {
      if (!search.may_match || search.may_match(query.keypoint, other.keypoint)) {
        candidates.push_back(other.keypoint);
      }
    }
    const TwoBest found =
        FindTwoBest(queries.descriptors[query.keypoint], candidates, features.descriptors);
    const bool is_distinct =
        search.max_ratio >= 1.0 || found.best < search.max_ratio * found.second;
    if (found.best <= search.max_distance && is_distinct) {
      matches.push_back({query.keypoint, found.keypoint, found.best});
    }
  }
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

std::vector<Match> MatchByWords(const FrameFeatures& queries,
                                std::span<const VocabularyNodeId> query_nodes,
                                const FrameFeatures& features,
                                std::span<const VocabularyNodeId> nodes, const WordSearch& search) {
  Check(query_nodes.size() == queries.size() && nodes.size() == features.size(),
        "there is not one node per keypoint");
  const std::vector<NodeKeypoint> all_queries = SortByNode(query_nodes);
  const std::vector<NodeKeypoint> all_keypoints = SortByNode(nodes);
  std::span<const NodeKeypoint> left_queries = all_queries;
  std::span<const NodeKeypoint> left_keypoints = all_keypoints;
  std::vector<Match> matches;
  while (!left_queries.empty() && !left_keypoints.empty()) {
    const auto same_queries = FirstNode(left_queries);
    const auto same_keypoints = FirstNode(left_keypoints);
    const VocabularyNodeId query_node = left_queries.front().node;
    const VocabularyNodeId node = left_keypoints.front().node;
    if (query_node == node) {
      MatchNode(queries, same_queries, features, same_keypoints, search, matches);
    }
    left_queries = left_queries.subspan(query_node <= node ? same_queries.size() : 0);
    left_keypoints = left_keypoints.subspan(node <= query_node ? same_keypoints.size() : 0);
  }
  KeepBestPerKeypoint(matches);
  if (search.compare_rotation) {
    KeepConsistentRotations(queries, features, matches);
  }
  return matches;
}

}  // namespace hullslam
