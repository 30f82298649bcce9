// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_files/train_vocabulary.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "bow/vocabulary_builder.h"
#include "hullslam/util/check.h"
#include "map_files/binary_clustering.h"
#include "util/hash.h"
#include "util/lists.h"

namespace hullslam {
namespace {

// A node whose descriptors are still to be divided.
struct OpenNode {
  uint32_t number = 0;  // TreeNode::parent of its children
  std::vector<Descriptor> descriptors;
};

std::vector<Descriptor> AllDescriptors(std::span<const std::vector<Descriptor>> images) {
  std::vector<Descriptor> all;
  for (const std::vector<Descriptor>& image : images) {
    all.insert(all.end(), image.begin(), image.end());
  }
  return all;
}

// Divides the nodes of a level. If there are few nodes, they are large: they are divided one after
// the other, each by several tasks. If there are many, each of them is one task.
std::vector<std::vector<BinaryCluster>> Divide(const std::vector<OpenNode>& open, int level,
                                               const VocabularyTraining& options,
                                               TaskRunner& runner,
                                               const Cancellation* cancellation) {
  constexpr size_t kFew = 16;
  std::vector<std::vector<BinaryCluster>> divided(open.size());
  const auto divide = [&](size_t i, TaskRunner& inner) {
    if (!IsRequested(cancellation)) {
      const uint64_t seed = HashSeed(options.seed, static_cast<uint32_t>(i),
                                     "vocabulary level " + std::to_string(level));
      divided[i] = ClusterBinary(open[i].descriptors, options.branching, seed, inner, cancellation);
    }
  };
  if (open.size() < kFew) {
    for (size_t i = 0; i < open.size(); ++i) {
      divide(i, runner);
    }
  } else {
    runner.Run(open.size(), [&](size_t i) {
      SerialRunner serial;
      divide(i, serial);
    });
  }
  return divided;
}

// Whether a cluster has different descriptors, so that it can be divided again.
bool IsDivisible(const std::vector<Descriptor>& descriptors) {
  return std::any_of(descriptors.begin(), descriptors.end(),
                     [&](const Descriptor& other) { return other != descriptors.front(); });
}

// Adds the clusters of a level to the tree, and returns those that can be divided again.
std::vector<OpenNode> AddLevel(const std::vector<OpenNode>& open,
                               const std::vector<std::vector<BinaryCluster>>& divided,
                               std::vector<TreeNode>& nodes) {
  std::vector<OpenNode> next;
  for (size_t i = 0; i < open.size(); ++i) {
    for (const BinaryCluster& cluster : divided[i]) {
      nodes.push_back({open[i].number, cluster.centre, 0.0f});
      OpenNode node{static_cast<uint32_t>(nodes.size()), {}};
      for (const uint32_t member : cluster.members) {
        node.descriptors.push_back(open[i].descriptors[member]);
      }
      if (IsDivisible(node.descriptors)) {
        next.push_back(std::move(node));
      }
    }
  }
  return next;
}

// ln(N / n) for each word, where N is the number of images and n the number of those that contain
// the word.
std::vector<float> InverseDocumentFrequencies(const Vocabulary& vocabulary,
                                              std::span<const std::vector<Descriptor>> images,
                                              TaskRunner& runner) {
  std::vector<std::vector<WordId>> words(images.size());
  runner.Run(images.size(), [&](size_t i) {
    words[i] = vocabulary.WordsOf(images[i]);
    SortUnique(words[i]);
  });
  std::vector<uint32_t> counts(vocabulary.word_count(), 0);
  for (const std::vector<WordId>& of_image : words) {
    for (const WordId word : of_image) {
      ++counts[word.value];
    }
  }
  std::vector<float> frequencies;
  frequencies.reserve(counts.size());
  for (const uint32_t count : counts) {
    // The count is above 0, because every word is the nearest word of the descriptors from which it
    // was made.
    Check(count > 0, "a word occurs in no image");
    frequencies.push_back(static_cast<float>(
        std::log(static_cast<double>(images.size()) / static_cast<double>(count))));
  }
  return frequencies;
}

}  // namespace

std::optional<Vocabulary> TrainVocabulary(std::span<const std::vector<Descriptor>> images,
                                          const VocabularyTraining& options, TaskRunner& runner,
                                          const Cancellation* cancellation,
                                          const ProgressCallback& on_progress) {
  Check(options.branching >= 2 && options.branching <= Vocabulary::kMostBranching,
        "the branching of a vocabulary is out of its range");
  Check(options.levels >= 1 && options.levels <= Vocabulary::kMostLevels,
        "the number of levels of a vocabulary is out of its range");
  std::vector<TreeNode> nodes;
  std::vector<OpenNode> open = {{0, AllDescriptors(images)}};
  Check(!open.front().descriptors.empty(), "a vocabulary needs descriptors");
  for (int level = 0; level < options.levels && !open.empty(); ++level) {
    const auto divided = Divide(open, level, options, runner, cancellation);
    if (IsRequested(cancellation)) {
      return std::nullopt;
    }
    open = AddLevel(open, divided, nodes);
    if (on_progress) {
      on_progress(level + 1, options.levels);
    }
  }
  const Vocabulary unweighted = BuildVocabulary(options.branching, options.levels, nodes);
  const std::vector<float> weights = InverseDocumentFrequencies(unweighted, images, runner);
  // The nodes were added level by level, so node i of the vocabulary is the i-th of them.
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (unweighted.first_child()[i + 1] == unweighted.first_child()[i + 2]) {
      nodes[i].weight = weights[unweighted.first_word()[i + 1]];
    }
  }
  return BuildVocabulary(options.branching, options.levels, nodes);
}

}  // namespace hullslam
