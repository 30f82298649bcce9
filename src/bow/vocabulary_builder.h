// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "hullslam/bow/vocabulary.h"
#include "hullslam/features/feature_set.h"

namespace hullslam {

// A node of a list in which parents come before their children.
struct TreeNode {
  uint32_t parent = 0;  // 0: the root; i: the i-th node of the list, counted from 1
  Descriptor descriptor{};
  float weight = 0.0f;  // inverse document frequency; only used if the node has no children
};

// Makes a vocabulary from a list of all nodes except the root. The order of siblings is kept. Nodes
// without children are the words. Throws CheckError if there are no nodes, a parent is not an
// earlier node, a node has more than `branching` children, or a leaf is more than `levels` steps
// from the root.
Vocabulary BuildVocabulary(int branching, int levels, std::span<const TreeNode> nodes);

}  // namespace hullslam
