// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/bow/vocabulary.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "bow/vocabulary_builder.h"
#include "hullslam/util/check.h"
#include "support/expect_error.h"
#include "support/made_vocabulary.h"

namespace hullslam {
namespace {

// The content of a vocabulary file in aligned memory.
class Content {
 public:
  explicit Content(const std::string& bytes) : memory_(bytes.size() / 8 + 1), size_(bytes.size()) {
    std::memcpy(memory_.data(), bytes.data(), bytes.size());
  }

  std::span<std::byte> bytes() { return {reinterpret_cast<std::byte*>(memory_.data()), size_}; }
  VocabularyHeader header() {
    VocabularyHeader header;
    std::memcpy(&header, bytes().data(), sizeof(header));
    return header;
  }
  void SetHeader(const VocabularyHeader& header) {
    std::memcpy(memory_.data(), &header, sizeof(header));
  }
  // Makes the hash fit the content.
  void Sign() {
    VocabularyHeader signed_header = header();
    signed_header.hash = HashVocabulary(bytes());
    SetHeader(signed_header);
  }
  template <typename Value>
  void Set(uint64_t offset, const Value& value) {
    std::memcpy(bytes().data() + offset, &value, sizeof(value));
  }

 private:
  std::vector<uint64_t> memory_;
  size_t size_;
};

Vocabulary View(Content& content) { return Vocabulary::View(content.bytes(), nullptr, "a.bow"); }

void ExpectRefused(Content& content, const std::string& why) {
  ExpectInputError([&] { View(content); }, {"a.bow: ", why});
}

// A file of 2 children per node and 2 levels (7 nodes, 4 words), changed and signed again.
void ExpectRefused(const std::function<void(Content&, const VocabularyLayout&)>& change,
                   const std::string& why) {
  Content content(BytesOf(MadeVocabulary(2, 2)));
  change(content, VocabularyLayout(7, 4));
  content.Sign();
  ExpectRefused(content, why);
}

WordId NearestByLevels(const Vocabulary& vocabulary, const Descriptor& descriptor) {
  uint32_t node = 0;
  const auto first = vocabulary.first_child();
  while (first[node] < first[node + 1]) {
    uint32_t best = first[node];
    for (uint32_t child = best; child < first[node + 1]; ++child) {
      if (HammingDistance(descriptor, vocabulary.descriptors()[child]) <
          HammingDistance(descriptor, vocabulary.descriptors()[best])) {
        best = child;
      }
    }
    node = best;
  }
  return WordId(vocabulary.first_word()[node]);
}

TEST(Vocabulary, AViewOfItsBytesIsTheSameVocabulary) {
  const Vocabulary made = MadeVocabulary();
  Content content(BytesOf(made));
  const Vocabulary viewed = View(content);
  EXPECT_EQ(viewed.hash(), made.hash());
  EXPECT_EQ(viewed.branching(), 4);
  EXPECT_EQ(viewed.levels(), 3);
  EXPECT_EQ(viewed.node_count(), 1u + 4u + 16u + 64u);
  EXPECT_EQ(viewed.word_count(), 64u);
}

TEST(Vocabulary, TheHashTellsVocabulariesApart) {
  EXPECT_EQ(MadeVocabulary(4, 3, 1).hash(), MadeVocabulary(4, 3, 1).hash());
  EXPECT_NE(MadeVocabulary(4, 3, 1).hash(), MadeVocabulary(4, 3, 2).hash());
}

TEST(Vocabulary, ADescriptorGoesToTheNearestChildOfEachLevel) {
  const Vocabulary vocabulary = MadeVocabulary(5, 4);
  std::mt19937_64 random(7);
  std::vector<Descriptor> descriptors;
  for (int i = 0; i < 300; ++i) {
    descriptors.push_back(RandomDescriptor(random));
  }
  const std::vector<WordId> words = vocabulary.WordsOf(descriptors);
  ASSERT_EQ(words.size(), descriptors.size());
  for (size_t i = 0; i < words.size(); ++i) {
    EXPECT_EQ(words[i], NearestByLevels(vocabulary, descriptors[i]));
  }
  EXPECT_TRUE(vocabulary.WordsOf({}).empty());
}

TEST(Vocabulary, EqualDistancesGoToTheFirstChild) {
  const std::vector<TreeNode> nodes = {{0, {3, 0, 0, 0}, 1.0f}, {0, {12, 0, 0, 0}, 1.0f}};
  const Vocabulary vocabulary = BuildVocabulary(2, 1, nodes);
  const std::vector<Descriptor> between = {Descriptor{}, Descriptor{15, 0, 0, 0},
                                           Descriptor{12, 0, 0, 0}};
  EXPECT_EQ(vocabulary.WordsOf(between), (std::vector<WordId>{WordId(0), WordId(0), WordId(1)}));
}

TEST(Vocabulary, TheNodeOfAWordHasTheWordBelowIt) {
  const Vocabulary vocabulary = MadeVocabulary(3, 4);
  const auto first_word = vocabulary.first_word();
  for (uint32_t word = 0; word < vocabulary.word_count(); ++word) {
    EXPECT_EQ(vocabulary.NodeOf(WordId(word), 0).value, 0u);
    EXPECT_EQ(first_word[vocabulary.NodeOf(WordId(word), 4).value], word);
    EXPECT_EQ(vocabulary.NodeOf(WordId(word), 9), vocabulary.NodeOf(WordId(word), 4));
    for (int level = 1; level <= 4; ++level) {
      const uint32_t node = vocabulary.NodeOf(WordId(word), level).value;
      const uint32_t parent = vocabulary.NodeOf(WordId(word), level - 1).value;
      EXPECT_GE(node, vocabulary.first_child()[parent]);
      EXPECT_LT(node, vocabulary.first_child()[parent + 1]);
      // 3^(4 - level) words are below a node of this level.
      const uint32_t below = level == 4 ? 1 : level == 3 ? 3 : level == 2 ? 9 : 27;
      EXPECT_EQ(first_word[node], word / below * below);
    }
  }
  EXPECT_THROW(vocabulary.NodeOf(WordId(81), 1), CheckError);
  EXPECT_EQ(vocabulary.NodesOf(std::vector<WordId>{WordId(80), WordId(0)}, 1),
            (std::vector<VocabularyNodeId>{VocabularyNodeId(3), VocabularyNodeId(1)}));
}

TEST(Vocabulary, AVectorIsFrequencyTimesInverseDocumentFrequency) {
  std::vector<TreeNode> nodes = FullTree(4, 1, 1);
  nodes[0].weight = 1.0f;
  nodes[1].weight = 2.0f;
  nodes[2].weight = 0.0f;  // the weight of a word that all training images contain
  nodes[3].weight = 5.0f;
  const Vocabulary vocabulary = BuildVocabulary(4, 1, nodes);
  const std::vector<WordId> words = {WordId(1), WordId(0), WordId(2), WordId(1), WordId(1)};
  EXPECT_EQ(vocabulary.VectorOf(words),
            (BowVector{{WordId(0), 1.0f / 7.0f}, {WordId(1), 6.0f / 7.0f}}));
  EXPECT_TRUE(vocabulary.VectorOf({}).empty());
  EXPECT_TRUE(vocabulary.VectorOf(std::vector<WordId>{WordId(2)}).empty());
  EXPECT_THROW(vocabulary.VectorOf(std::vector<WordId>{WordId(4)}), CheckError);
  EXPECT_THROW(vocabulary.VectorOf(std::vector<WordId>{WordId()}), CheckError);
}

TEST(Vocabulary, OtherFilesAreNoVocabulary) {
  for (const char* const text : {"", "HULL", "%YAML:1.0 and more text"}) {
    Content content(text);
    ExpectRefused(content, "is not a vocabulary");
  }
}

TEST(Vocabulary, EveryCutIsNoticed) {
  const std::string bytes = BytesOf(MadeVocabulary(2, 2));
  for (size_t size = 8; size < bytes.size(); ++size) {
    Content content(bytes.substr(0, size));
    ExpectRefused(content, "cut off");
  }
}

TEST(Vocabulary, EveryFlippedBitIsNoticed) {
  const std::string bytes = BytesOf(MadeVocabulary(2, 2));
  for (size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 4);
    Content content(damaged);
    ExpectRefused(content, "");
  }
}

// The hash is computed again after the change, so that the other checks must find the fault.
TEST(Vocabulary, AWrongHeaderIsRefused) {
  const auto change = [](auto field, uint32_t value) {
    return [=](Content& content, const VocabularyLayout&) {
      VocabularyHeader header = content.header();
      header.*field = value;
      content.SetHeader(header);
    };
  };
  ExpectRefused(change(&VocabularyHeader::version, 2), "version 2, expected 1");
  ExpectRefused(change(&VocabularyHeader::branching, 1), "branching 1, expected 2 to 100");
  ExpectRefused(change(&VocabularyHeader::levels, 11), "levels 11, expected 1 to 10");
  ExpectRefused(change(&VocabularyHeader::levels, 1), "has 2 levels, expected at most 1");
  ExpectRefused(change(&VocabularyHeader::node_count, 1), "nodes 1, expected 2");
  ExpectRefused(change(&VocabularyHeader::node_count, 8), "cut off or damaged");
  ExpectRefused(change(&VocabularyHeader::node_count, 0x7fffffff), "cut off or damaged");
  ExpectRefused(change(&VocabularyHeader::word_count, 0), "words 0, expected 1 to 6");
  ExpectRefused(change(&VocabularyHeader::unused, 1), "unused bytes of its header are not 0");
}

// No word depends on it, and the text form does not have it, but the hash would differ.
TEST(Vocabulary, ARootWithADescriptorIsRefused) {
  ExpectRefused([](Content& content,
                   const VocabularyLayout& layout) { content.Set(layout.descriptors + 16, 1); },
                "the root has a descriptor");
}

TEST(Vocabulary, AWrongTreeIsRefused) {
  const auto child = [](uint64_t node, uint32_t value) {
    return [=](Content& content, const VocabularyLayout& layout) {
      content.Set(layout.first_child + 4 * node, value);
    };
  };
  ExpectRefused(child(0, 0), "are not all other nodes");
  ExpectRefused(child(7, 9), "are not all other nodes");
  ExpectRefused(child(1, 0xffffffff), "impossible children");
  ExpectRefused(child(1, 1), "impossible children");  // node 1 would be its own child
  ExpectRefused(child(2, 6), "impossible children");  // three children of node 1
}

TEST(Vocabulary, WrongWordsAreRefused) {
  const auto word = [](uint64_t node, uint32_t value) {
    return [=](Content& content, const VocabularyLayout& layout) {
      content.Set(layout.first_word + 4 * node, value);
    };
  };
  ExpectRefused(word(0, 1), "the first word is not word 0");
  for (uint64_t node = 1; node < 7; ++node) {
    ExpectRefused(word(node, 0xffffffff), "out of order");
  }
  ExpectRefused(word(2, 3), "out of order");
  ExpectRefused(word(2, 1), "out of order");
}

TEST(Vocabulary, WrongWeightsAreRefused) {
  for (const float weight :
       {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    ExpectRefused([&](Content& content,
                      const VocabularyLayout& layout) { content.Set(layout.weights + 8, weight); },
                  "word 2 has weight");
  }
}

}  // namespace
}  // namespace hullslam
