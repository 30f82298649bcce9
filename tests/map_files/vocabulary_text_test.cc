// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_files/vocabulary_text.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "support/expect_error.h"
#include "support/made_vocabulary.h"

namespace hullslam {
namespace {

// The line of a node. The first byte of its descriptor is `byte`; all others are 0.
std::string Node(int parent, bool is_leaf, int byte, const std::string& weight = "0") {
  std::string line = std::to_string(parent) + (is_leaf ? " 1 " : " 0 ") + std::to_string(byte);
  for (int i = 1; i < 32; ++i) {
    line += " 0";
  }
  return line + ' ' + weight + '\n';
}

Vocabulary Parse(const std::string& text) { return ParseVocabularyText(text, "voc.txt", {}); }

void ExpectRefused(const std::string& text, const std::string& position, const std::string& why) {
  ExpectInputError([&] { Parse(text); }, {position, why});
}

TEST(VocabularyText, IsReadLineByLine) {
  const Vocabulary vocabulary = Parse("2 2 0 0 \n" + Node(0, false, 1) + Node(0, true, 255, "0.5") +
                                      Node(1, true, 7, "1.25") + Node(1, true, 128, "1e-3 "));
  EXPECT_EQ(vocabulary.branching(), 2);
  EXPECT_EQ(vocabulary.levels(), 2);
  EXPECT_EQ(vocabulary.node_count(), 5u);
  EXPECT_EQ(vocabulary.word_count(), 3u);
  EXPECT_EQ(vocabulary.weights()[0], 1.25f);
  EXPECT_EQ(vocabulary.weights()[1], 1e-3f);
  EXPECT_EQ(vocabulary.weights()[2], 0.5f);
  EXPECT_EQ(vocabulary.descriptors()[2], (Descriptor{255, 0, 0, 0}));
}

// The first byte has the lowest bits, as in the descriptors of OpenCV.
TEST(VocabularyText, BytesAreInTheOrderOfOpenCv) {
  std::string line = "0 1";
  for (int i = 0; i < 32; ++i) {
    line += ' ' + std::to_string(i + 1);
  }
  const Vocabulary vocabulary = Parse("2 1 0 0\n" + line + " 1\n");
  EXPECT_EQ(vocabulary.descriptors()[1], (Descriptor{0x0807060504030201, 0x100f0e0d0c0b0a09,
                                                     0x1817161514131211, 0x201f1e1d1c1b1a19}));
}

TEST(VocabularyText, WindowsLineEndsAndEmptyLinesAtTheEndAreAccepted) {
  EXPECT_EQ(Parse("2 1 0 0\r\n0 1" + Node(0, true, 1).substr(3, 64) + " 1\r\n\r\n\n \n").hash(),
            Parse("2 1 0 0\n" + Node(0, true, 1, "1")).hash());
}

TEST(VocabularyText, WritingAndReadingGivesTheSameBits) {
  std::vector<TreeNode> nodes = FullTree(5, 3, 1);
  for (size_t i = 0; i < nodes.size(); ++i) {
    nodes[i].weight = 10.0f / static_cast<float>(i + 3);
  }
  const Vocabulary vocabulary = BuildVocabulary(5, 3, nodes);
  const std::string text = FormatVocabularyText(vocabulary);
  EXPECT_EQ(Parse(text).hash(), vocabulary.hash());
  EXPECT_EQ(FormatVocabularyText(Parse(text)), text);
}

TEST(VocabularyText, TheFirstLineIsChecked) {
  ExpectRefused("1 2 0 0\n", "voc.txt:1: ", "branching k '1', expected a number from 2 to 100");
  ExpectRefused("10 99 0 0\n", "voc.txt:1: ", "levels L '99', expected a number from 1 to 10");
  ExpectRefused("10 6 1 0\n", "voc.txt:1: ", "scoring 1, expected 0 (L1 norm)");
  ExpectRefused("10 6 0 2\n", "voc.txt:1: ", "weighting 2, expected 0 (tf-idf)");
  ExpectRefused("10 6 0\n", "voc.txt:1: ", "weighting is missing");
  ExpectRefused("10 6 0 0 0\n", "voc.txt:1: ", "more than 4 columns");
  ExpectRefused("10 6 0 0", "voc.txt: ", "no words");
}

TEST(VocabularyText, BrokenLinesAreNamed) {
  const std::string good = "2 2 0 0\n" + Node(0, true, 1, "1");
  ExpectRefused(good + "\n" + Node(0, true, 1), "voc.txt:3: ", "is empty");
  ExpectRefused(good + "0 1 2 3\n", "voc.txt:3: ", "byte of the descriptor is missing");
  ExpectRefused(good + Node(0, true, 256), "voc.txt:3: ", "'256', expected a number from 0 to 255");
  ExpectRefused(good + Node(0, true, -1), "voc.txt:3: ", "'-1'");
  ExpectRefused(good + "x 1 0\n", "voc.txt:3: ", "parent 'x'");
  ExpectRefused(good + "0x 1 0\n", "voc.txt:3: ", "parent '0x'");
  ExpectRefused(good + "0 2 0\n", "voc.txt:3: ", "is_leaf '2'");
  // The descriptor of a good node has 32 bytes; here a node has too many or too few columns.
  ExpectRefused(good + Node(0, true, 1, "0 0"), "voc.txt:3: ", "more than 35 columns");
  ExpectRefused(good + "0 1" + Node(0, true, 1).substr(5), "voc.txt:3: ", "weight is missing");
}

TEST(VocabularyText, WrongWeightsAreRefused) {
  for (const char* const weight : {"nan", "inf", "-1", "-nan", "1e300", "1001"}) {
    ExpectRefused("2 2 0 0\n" + Node(0, true, 1, weight), "voc.txt:2: ",
                  std::string("weight '") + weight + "', expected a number from 0 to 1000");
  }
}

TEST(VocabularyText, WrongTreesAreRefused) {
  const std::string good = "2 2 0 0\n" + Node(0, false, 1) + Node(1, true, 2, "1");
  EXPECT_EQ(Parse(good).word_count(), 1u);
  ExpectRefused(good + Node(3, true, 1),
                "voc.txt:4: ", "parent 3 is not an earlier node; this is node 3");
  ExpectRefused(good + Node(9, true, 1), "voc.txt:4: ", "parent 9 is not an earlier node");
  ExpectRefused(good + Node(2, true, 1), "voc.txt:4: ", "the parent, node 2, is a leaf");
  ExpectRefused(good + Node(1, false, 1) + Node(3, true, 1),
                "voc.txt:5: ", "node 4 is on level 3, expected at most 2");
  ExpectRefused(good + Node(1, true, 1) + Node(1, true, 1),
                "voc.txt:5: ", "node 1 has more than 2 children");
  ExpectRefused(good + Node(0, false, 1),
                "voc.txt:4: ", "node 3 is not a leaf, but has no children");
}

TEST(VocabularyText, ProgressIsInMegabytes) {
  const std::string text = FormatVocabularyText(MadeVocabulary(40, 3));  // 65 640 nodes
  std::vector<std::pair<int, int>> told;
  ParseVocabularyText(text, "voc.txt", [&](int done, int most) { told.emplace_back(done, most); });
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].second, static_cast<int>(text.size() / 1'000'000));
  EXPECT_NEAR(told[0].first, told[0].second * 50.0 / 65.6, 1.0);
}

}  // namespace
}  // namespace hullslam
