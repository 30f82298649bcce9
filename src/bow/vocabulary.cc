// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/bow/vocabulary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include "bow/vocabulary_builder.h"
#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "util/function_clones.h"

namespace hullslam {
namespace {

class Reader {
 public:
  Reader(std::span<const std::byte> bytes, std::string_view name) : bytes_(bytes), name_(name) {}

  [[noreturn]] void Fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", name_, what));
  }

  // Reads the header and checks everything that can be checked without the rest of the file.
  VocabularyHeader ReadHeader() const {
    if (!Vocabulary::IsBinary(bytes_)) {
      Fail("is not a vocabulary of HullSLAM");
    }
    if (bytes_.size() < sizeof(VocabularyHeader)) {
      Fail(fmt::format("has {} bytes, so it is cut off within its header", bytes_.size()));
    }
    VocabularyHeader header;
    std::memcpy(&header, bytes_.data(), sizeof(header));
    if (header.version != kVocabularyVersion) {
      Fail(fmt::format("has version {}, expected {}", header.version, kVocabularyVersion));
    }
    if (header.unused != 0 || header.padding != decltype(header.padding){}) {
      Fail("is damaged: the unused bytes of its header are not 0");
    }
    CheckRange("branching", header.branching, 2, Vocabulary::kMostBranching);
    CheckRange("levels", header.levels, 1, Vocabulary::kMostLevels);
    CheckRange("nodes", header.node_count, 2, std::numeric_limits<int>::max());
    CheckRange("words", header.word_count, 1, header.node_count - 1);
    const VocabularyLayout layout(header.node_count, header.word_count);
    if (bytes_.size() != layout.size) {
      Fail(
          fmt::format("has {} bytes, expected {} for {} nodes and {} words: it is cut off or "
                      "damaged",
                      bytes_.size(), layout.size, header.node_count, header.word_count));
    }
    if (HashVocabulary(bytes_) != header.hash) {
      Fail("is damaged: its content does not have the hash that its header gives");
    }
    return header;
  }

  template <typename Value>
  std::span<const Value> Part(uint64_t begin, size_t count) const {
    return {reinterpret_cast<const Value*>(bytes_.data() + begin), count};
  }

 private:
  void CheckRange(const char* what, uint32_t value, uint32_t least, uint32_t most) const {
    if (value < least || value > most) {
      Fail(fmt::format("{} {}, expected {} to {}", what, value, least, most));
    }
  }

  std::span<const std::byte> bytes_;
  std::string_view name_;
};

// Describes the fault of the tree; empty if the tree is valid. If the children of node 0 begin at
// node 1, and the children of each other node begin where the previous node's children end, then
// every node except the root has exactly one parent.
std::string FindTreeFault(std::span<const uint32_t> first_child, const VocabularyHeader& header) {
  const uint32_t count = header.node_count;
  if (first_child[0] != 1 || first_child[count] != count) {
    return "the children of its nodes are not all other nodes";
  }
  for (uint32_t node = 0; node < count; ++node) {
    const uint32_t begin = first_child[node];
    const uint32_t end = first_child[node + 1];
    if (end < begin || end - begin > header.branching || (end > begin && begin <= node)) {
      return fmt::format("node {} has impossible children", node);
    }
  }
  uint32_t level = 0;
  for (uint32_t end = 1; end < count; ++level) {
    end = first_child[end];  // this level's children end where the next level's begin
  }
  return level > header.levels
             ? fmt::format("has {} levels, expected at most {}", level, header.levels)
             : std::string();
}

// Describes the fault of the numbers of the words; empty if they are in depth-first order.
std::string FindWordFault(std::span<const uint32_t> first_child,
                          std::span<const uint32_t> first_word, const VocabularyHeader& header) {
  if (first_word[0] != 0) {
    return "the first word is not word 0";
  }
  std::vector<uint32_t> end_word(header.node_count);  // for each node: one past its last word
  end_word[0] = header.word_count;
  for (uint32_t node = 0; node < header.node_count; ++node) {
    const uint32_t begin = first_child[node];
    const uint32_t end = first_child[node + 1];
    bool good = first_word[node] < end_word[node];
    if (begin == end) {
      good = good && end_word[node] - first_word[node] == 1;
    } else {
      good = good && first_word[begin] == first_word[node];
      for (uint32_t child = begin; child + 1 < end; ++child) {
        end_word[child] = first_word[child + 1];
      }
      end_word[end - 1] = end_word[node];
    }
    if (!good) {
      return fmt::format("node {} has words out of order", node);
    }
  }
  return {};
}

std::string FindWeightFault(std::span<const float> weights) {
  const auto bad = std::find_if(weights.begin(), weights.end(),
                                [](float weight) { return !IsPossibleWeight(weight); });
  return bad == weights.end() ? std::string()
                              : fmt::format("word {} has weight {}, expected a number from 0 to {}",
                                            bad - weights.begin(), *bad, kMostWordWeight);
}

// Finds the word of each descriptor.
HULLSLAM_FUNCTION_CLONES
void FindWords(std::span<const Descriptor> descriptors, const Descriptor* nodes,
               const uint32_t* first_child, const uint32_t* first_word, WordId* words) {
  for (size_t i = 0; i < descriptors.size(); ++i) {
    const Descriptor descriptor = descriptors[i];
    uint32_t node = 0;
    while (first_child[node] < first_child[node + 1]) {
      const uint32_t end = first_child[node + 1];
      int least = std::numeric_limits<int>::max();
      uint32_t nearest = first_child[node];
      for (uint32_t child = first_child[node]; child < end; ++child) {
        const int distance = HammingDistance(descriptor, nodes[child]);
        if (distance < least) {
          least = distance;
          nearest = child;
        }
      }
      node = nearest;
    }
    words[i] = WordId(first_word[node]);
  }
}

}  // namespace

Vocabulary Vocabulary::View(std::span<const std::byte> bytes, std::shared_ptr<const void> owner,
                            std::string_view name) {
  Check(reinterpret_cast<uintptr_t>(bytes.data()) % alignof(Descriptor) == 0,
        "the bytes of a vocabulary are not aligned");
  const Reader reader(bytes, name);
  const VocabularyHeader header = reader.ReadHeader();
  const VocabularyLayout layout(header.node_count, header.word_count);
  Vocabulary vocabulary;
  vocabulary.owner_ = std::move(owner);
  vocabulary.bytes_ = bytes;
  vocabulary.descriptors_ = reader.Part<Descriptor>(layout.descriptors, header.node_count);
  vocabulary.first_child_ =
      reader.Part<uint32_t>(layout.first_child, header.node_count + size_t{1});
  vocabulary.first_word_ = reader.Part<uint32_t>(layout.first_word, header.node_count);
  vocabulary.weights_ = reader.Part<float>(layout.weights, header.word_count);
  vocabulary.branching_ = static_cast<int>(header.branching);
  vocabulary.levels_ = static_cast<int>(header.levels);
  vocabulary.hash_ = header.hash;
  std::string fault = vocabulary.descriptors_[0] == Descriptor{}
                          ? FindTreeFault(vocabulary.first_child_, header)
                          : "the root has a descriptor, expected zeros";
  if (fault.empty()) {
    fault = FindWordFault(vocabulary.first_child_, vocabulary.first_word_, header);
  }
  if (fault.empty()) {
    fault = FindWeightFault(vocabulary.weights_);
  }
  if (!fault.empty()) {
    reader.Fail(fault);
  }
  return vocabulary;
}

bool Vocabulary::IsBinary(std::span<const std::byte> bytes) {
  return bytes.size() >= kVocabularyMagic.size() &&
         std::memcmp(bytes.data(), kVocabularyMagic.data(), kVocabularyMagic.size()) == 0;
}

std::vector<WordId> Vocabulary::WordsOf(std::span<const Descriptor> descriptors) const {
  std::vector<WordId> words(descriptors.size());
  FindWords(descriptors, descriptors_.data(), first_child_.data(), first_word_.data(),
            words.data());
  return words;
}

BowVector Vocabulary::VectorOf(std::span<const WordId> words) const {
  std::vector<WordId> sorted(words.begin(), words.end());
  std::sort(sorted.begin(), sorted.end());
  Check(sorted.empty() || sorted.back().value < word_count(), "no word of this vocabulary");
  BowVector vector;
  vector.reserve(sorted.size());
  double sum = 0.0;
  for (size_t i = 0; i < sorted.size();) {
    const WordId word = sorted[i];
    size_t count = 0;
    for (; i < sorted.size() && sorted[i] == word; ++i) {
      ++count;
    }
    const float weight = static_cast<float>(count) * weights_[word.value];
    if (weight > 0.0f) {
      vector.push_back({word, weight});
      sum += static_cast<double>(weight);
    }
  }
  for (WeightedWord& weighted : vector) {
    weighted.weight = static_cast<float>(static_cast<double>(weighted.weight) / sum);
  }
  return vector;
}

VocabularyNodeId Vocabulary::NodeOf(WordId word, int level) const {
  Check(word.value < word_count(), "no word of this vocabulary");
  uint32_t node = 0;
  for (int step = 0; step < level && first_child_[node] < first_child_[node + 1]; ++step) {
    const auto children = first_word_.begin();
    const auto after = std::upper_bound(children + first_child_[node],
                                        children + first_child_[node + 1], word.value);
    node = static_cast<uint32_t>(after - children) - 1;
  }
  return VocabularyNodeId(node);
}

std::vector<VocabularyNodeId> Vocabulary::NodesOf(std::span<const WordId> words, int level) const {
  std::vector<VocabularyNodeId> nodes;
  nodes.reserve(words.size());
  for (const WordId word : words) {
    nodes.push_back(NodeOf(word, level));
  }
  return nodes;
}

}  // namespace hullslam
