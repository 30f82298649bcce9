// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "hullslam/bow/bow_vector.h"
#include "hullslam/features/feature_set.h"
#include "hullslam/util/id.h"

namespace hullslam {

// A node of the vocabulary tree. Node 0 is the root.
using VocabularyNodeId = Id<struct VocabularyNodeTag>;

// A tree of binary words (Galvez-Lopez and Tardos 2012). A descriptor goes down from the root,
// always to the child with the least Hamming distance (ties go to the first child), and its word is
// the leaf where it arrives. The weight of a word is its inverse document frequency ln(N / n),
// where N is the number of training images and n the number of those that contain the word.
//
// Nodes are numbered level by level, so that siblings are neighbours in memory. Words are numbered
// in depth-first order, so that the words below a node are a range, and the node of a word at any
// level follows from the word alone. This replaces a stored direct index: a frame only keeps its
// words.
//
// The memory has the content of the binary file (docs/maps.md). Copies share it. All
// functions are const and may be called by several threads.
class Vocabulary {
 public:
  static constexpr int kMostBranching = 100;
  static constexpr int kMostLevels = 10;

  // `bytes` is the content of a binary file and is not copied; `owner` keeps it alive. It must be
  // aligned to 8 bytes. Checks everything that later calls rely on. Throws InputError that begins
  // with `name` if the bytes are no vocabulary, are cut off or damaged.
  static Vocabulary View(std::span<const std::byte> bytes, std::shared_ptr<const void> owner,
                         std::string_view name);

  // Whether the bytes begin with the mark of a binary vocabulary.
  static bool IsBinary(std::span<const std::byte> bytes);

  int branching() const { return branching_; }  // largest number of children of a node
  int levels() const { return levels_; }        // largest number of steps from the root to a leaf
  size_t node_count() const { return descriptors_.size(); }
  size_t word_count() const { return weights_.size(); }
  // The hash of the whole content. Words of two vocabularies can be compared if and only if their
  // hashes are equal.
  uint64_t hash() const { return hash_; }
  // The content of the binary file.
  std::span<const std::byte> bytes() const { return bytes_; }

  // One word per descriptor.
  std::vector<WordId> WordsOf(std::span<const Descriptor> descriptors) const;
  // Weight of each word: its frequency among `words` times its inverse document frequency,
  // normalised to the sum 1. Words that all training images contain have weight 0 and are left out.
  // Throws CheckError if a word is not one of this vocabulary.
  BowVector VectorOf(std::span<const WordId> words) const;

  // The node that the descriptors of `word` reach after `level` steps from the root; the leaf
  // itself if it is reached in fewer steps. Throws CheckError if the word is not one of this
  // vocabulary.
  VocabularyNodeId NodeOf(WordId word, int level) const;
  // The same for many words. Throws like NodeOf().
  std::vector<VocabularyNodeId> NodesOf(std::span<const WordId> words, int level) const;

  // Inverse document frequency of each word.
  std::span<const float> weights() const { return weights_; }
  // One per node; zero for the root.
  std::span<const Descriptor> descriptors() const { return descriptors_; }
  // The children of node i are the nodes first_child[i] to first_child[i + 1] - 1; a leaf has none.
  // The list has one entry more than there are nodes.
  std::span<const uint32_t> first_child() const { return first_child_; }
  // The first word below each node; of a leaf: its word.
  std::span<const uint32_t> first_word() const { return first_word_; }

 private:
  Vocabulary() = default;

  std::shared_ptr<const void> owner_;
  std::span<const std::byte> bytes_;
  std::span<const Descriptor> descriptors_;
  std::span<const uint32_t> first_child_;
  std::span<const uint32_t> first_word_;
  std::span<const float> weights_;
  int branching_ = 0;
  int levels_ = 0;
  uint64_t hash_ = 0;
};

}  // namespace hullslam
