// SPDX-License-Identifier: GPL-3.0-or-later
#include "bow/vocabulary_builder.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstring>
#include <memory>
#include <vector>

#include "hullslam/util/check.h"
#include "hullslam/util/error.h"

namespace hullslam {

uint64_t HashVocabulary(std::span<const std::byte> bytes) {
  VocabularyHeader header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  header.hash = 0;
  const std::span<const std::byte> body = bytes.subspan(sizeof(header));
  return XXH3_64bits_withSeed(body.data(), body.size(), XXH3_64bits(&header, sizeof(header)));
}

namespace {

// The children of all nodes, in the order of the list: node i has children[begin[i]] to
// children[begin[i + 1] - 1].
struct ChildLists {
  std::vector<uint32_t> begin;
  std::vector<uint32_t> children;
};

ChildLists ListChildren(std::span<const TreeNode> nodes) {
  ChildLists lists{std::vector<uint32_t>(nodes.size() + 2), std::vector<uint32_t>(nodes.size())};
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    Check(nodes[i].parent <= i, "the parent of a node is not an earlier node");
    ++lists.begin[nodes[i].parent + 1];
  }
  for (size_t i = 1; i < lists.begin.size(); ++i) {
    lists.begin[i] += lists.begin[i - 1];
  }
  std::vector<uint32_t> next(lists.begin.begin(), lists.begin.end() - 1);
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    lists.children[next[nodes[i].parent]++] = i + 1;
  }
  return lists;
}

// The tree with its nodes numbered level by level.
struct LevelOrder {
  std::vector<uint32_t> given;        // the number of each node in the list; 0 is the root
  std::vector<uint32_t> first_child;  // as in Vocabulary
};

LevelOrder SortByLevel(const ChildLists& lists) {
  LevelOrder order;
  const size_t count = lists.children.size() + 1;
  order.given.reserve(count);
  order.first_child.reserve(count + 1);
  order.given.push_back(0);
  for (size_t node = 0; node < order.given.size(); ++node) {
    const uint32_t given = order.given[node];
    order.first_child.push_back(static_cast<uint32_t>(order.given.size()));
    order.given.insert(order.given.end(), lists.children.begin() + lists.begin[given],
                       lists.children.begin() + lists.begin[given + 1]);
  }
  order.first_child.push_back(static_cast<uint32_t>(count));
  return order;
}

// The first word below each node, if words are numbered in depth-first order.
std::vector<uint32_t> NumberWords(const std::vector<uint32_t>& first_child) {
  const size_t count = first_child.size() - 1;
  std::vector<uint32_t> words(count, 0);  // number of words below each node
  for (size_t node = count; node-- > 0;) {
    for (uint32_t child = first_child[node]; child < first_child[node + 1]; ++child) {
      words[node] += words[child];
    }
    if (first_child[node] == first_child[node + 1]) {
      words[node] = 1;
    }
  }
  std::vector<uint32_t> first_word(count, 0);
  for (size_t node = 0; node < count; ++node) {
    uint32_t word = first_word[node];
    for (uint32_t child = first_child[node]; child < first_child[node + 1]; ++child) {
      first_word[child] = word;
      word += words[child];
    }
  }
  return first_word;
}

// Writes the parts after the header. `bytes` has the size of the whole file.
void WriteParts(const LevelOrder& order, std::span<const TreeNode> nodes,
                const VocabularyLayout& layout, std::byte* bytes) {
  const size_t count = order.given.size();
  const std::vector<uint32_t> first_word = NumberWords(order.first_child);
  std::memcpy(bytes + layout.first_child, order.first_child.data(), 4 * (count + 1));
  std::memcpy(bytes + layout.first_word, first_word.data(), 4 * count);
  for (size_t node = 1; node < count; ++node) {
    const TreeNode& given = nodes[order.given[node] - 1];
    std::memcpy(bytes + layout.descriptors + 32 * node, given.descriptor.data(), 32);
    if (order.first_child[node] == order.first_child[node + 1]) {
      std::memcpy(bytes + layout.weights + size_t{4} * first_word[node], &given.weight, 4);
    }
  }
}

}  // namespace

Vocabulary BuildVocabulary(int branching, int levels, std::span<const TreeNode> nodes) {
  Check(!nodes.empty(), "a vocabulary needs words");
  const LevelOrder order = SortByLevel(ListChildren(nodes));
  uint32_t word_count = 0;
  for (size_t node = 0; node < order.given.size(); ++node) {
    word_count += order.first_child[node] == order.first_child[node + 1] ? 1 : 0;
  }
  const VocabularyLayout layout(order.given.size(), word_count);
  // The memory is allocated as numbers of 8 bytes, so that it is aligned.
  auto memory = std::make_shared<std::vector<uint64_t>>((layout.size + 7) / 8);
  auto* const bytes = reinterpret_cast<std::byte*>(memory->data());
  WriteParts(order, nodes, layout, bytes);
  VocabularyHeader header{.branching = static_cast<uint32_t>(branching),
                          .levels = static_cast<uint32_t>(levels),
                          .node_count = static_cast<uint32_t>(order.given.size()),
                          .word_count = word_count};
  std::memcpy(bytes, &header, sizeof(header));
  header.hash = HashVocabulary({bytes, layout.size});
  std::memcpy(bytes, &header, sizeof(header));
  try {
    return Vocabulary::View({bytes, layout.size}, std::move(memory), "the vocabulary");
  } catch (const InputError& error) {
    throw CheckError(error.what());  // the nodes come from the caller, not from a file of the user
  }
}

}  // namespace hullslam
