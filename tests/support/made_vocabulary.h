// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "bow/vocabulary_builder.h"
#include "hullslam/bow/vocabulary.h"

namespace hullslam {

inline Descriptor RandomDescriptor(std::mt19937_64& random) {
  Descriptor descriptor;
  for (uint64_t& word : descriptor) {
    word = random();
  }
  return descriptor;
}

// The nodes of a full tree with random descriptors: all leaves are `levels` steps from the root.
// Weights are 1.
inline std::vector<TreeNode> FullTree(int branching, int levels, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<TreeNode> nodes;
  std::vector<uint32_t> parents = {0};
  for (int level = 0; level < levels; ++level) {
    std::vector<uint32_t> next;
    for (const uint32_t parent : parents) {
      for (int child = 0; child < branching; ++child) {
        nodes.push_back({parent, RandomDescriptor(random), 1.0f});
        next.push_back(static_cast<uint32_t>(nodes.size()));
      }
    }
    parents = next;
  }
  return nodes;
}

inline Vocabulary MadeVocabulary(int branching = 4, int levels = 3, uint64_t seed = 1) {
  return BuildVocabulary(branching, levels, FullTree(branching, levels, seed));
}

inline std::shared_ptr<const Vocabulary> SharedVocabulary(int branching = 4, int levels = 3) {
  return std::make_shared<const Vocabulary>(MadeVocabulary(branching, levels));
}

// The content of its binary file.
inline std::string BytesOf(const Vocabulary& vocabulary) {
  return {reinterpret_cast<const char*>(vocabulary.bytes().data()), vocabulary.bytes().size()};
}

}  // namespace hullslam
