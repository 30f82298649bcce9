// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hullslam/bow/vocabulary.h"
#include "hullslam/features/feature_set.h"

namespace hullslam {

static_assert(std::endian::native == std::endian::little, "the file is little endian");

constexpr std::array<char, 8> kVocabularyMagic = {'H', 'U', 'L', 'L', 'B', 'O', 'W', '\n'};
constexpr uint32_t kVocabularyVersion = 1;

// ln(N / n) is below 50 for all counts of images. The limit keeps sums of weights finite.
constexpr float kMostWordWeight = 1000.0f;
inline bool IsPossibleWeight(float weight) {
  return weight >= 0.0f && weight <= kMostWordWeight;  // false for NaN
}

// The first 64 bytes of a binary vocabulary. They are followed, for N nodes and W words, by:
//   N descriptors of 32 bytes        first_child: N + 1 numbers of 4 bytes
//   first_word: N numbers of 4 bytes weights: W floats
// See class Vocabulary for their meaning.
struct VocabularyHeader {
  std::array<char, 8> magic = kVocabularyMagic;
  uint32_t version = kVocabularyVersion;
  uint32_t branching = 0;
  uint32_t levels = 0;
  uint32_t node_count = 0;
  uint32_t word_count = 0;
  uint32_t unused = 0;
  uint64_t hash = 0;  // HashVocabulary()
  std::array<uint8_t, 24> padding{};
};
static_assert(sizeof(VocabularyHeader) == 64);

// The offsets of the parts of the file, in bytes.
struct VocabularyLayout {
  uint64_t descriptors = sizeof(VocabularyHeader);
  uint64_t first_child = 0;
  uint64_t first_word = 0;
  uint64_t weights = 0;
  uint64_t size = 0;  // size of the file

  VocabularyLayout(uint64_t node_count, uint64_t word_count)
      : first_child(descriptors + 32 * node_count),
        first_word(first_child + 4 * (node_count + 1)),
        weights(first_word + 4 * node_count),
        size(weights + 4 * word_count) {}
};

// The 64-bit XXH3 hash of everything except the hash itself. The hash of the header, with 0 instead
// of the stored hash, is the seed for the rest of the file. `bytes` must contain a header.
uint64_t HashVocabulary(std::span<const std::byte> bytes);

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
