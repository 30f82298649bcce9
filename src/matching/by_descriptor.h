// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "hullslam/bow/vocabulary.h"
#include "hullslam/features/feature_grid.h"
#include "matching/match.h"

namespace hullslam {

struct DescriptorSearch {
  int max_distance = 50;   // Hamming
  double max_ratio = 0.7;  // largest ratio of the best distance to the second best
};

// Compares every keypoint of `queries` that is listed in `indices` with every keypoint of
// `features`, without a prediction of its position. The rotations of the matches must agree.
// Match::query is a keypoint index.
std::vector<Match> MatchByDescriptor(const FrameFeatures& queries,
                                     std::span<const uint32_t> indices,
                                     const FrameFeatures& features, const DescriptorSearch& search);

struct WordSearch {
  int max_distance = 50;   // Hamming
  double max_ratio = 0.7;  // largest ratio of the best distance to the second best; 1: no such test
  bool compare_rotation = true;
  // Decides whether a query (index) may be matched to a keypoint (index). It is asked before
  // descriptors are compared. Empty: all may be matched.
  std::function<bool(uint32_t, uint32_t)> may_match = {};
};

// Compares every keypoint of `queries` with those keypoints of `features` that have the same node
// of the vocabulary (the direct index of Galvez-Lopez and Tardos 2012), in ascending order of the
// nodes. `query_nodes` and `nodes` have one entry per keypoint, as from Vocabulary::NodesOf();
// keypoints whose node is invalid are not matched. A keypoint is matched to at most one query.
// Match::query is a keypoint index.
std::vector<Match> MatchByWords(const FrameFeatures& queries,
                                std::span<const VocabularyNodeId> query_nodes,
                                const FrameFeatures& features,
                                std::span<const VocabularyNodeId> nodes, const WordSearch& search);

}  // namespace hullslam
