// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/bow/inverted_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <tuple>
#include <vector>

#include "hullslam/util/check.h"
#include "support/made_vocabulary.h"

namespace hullslam {
namespace {

const BowVector kA = {{WordId(1), 0.25f}, {WordId(4), 0.75f}};
const BowVector kB = {{WordId(2), 0.5f}, {WordId(4), 0.5f}};

BowVector RandomVector(const Vocabulary& vocabulary, std::mt19937_64& random) {
  std::vector<WordId> words;
  for (int i = 0; i < 30; ++i) {
    words.push_back(WordId(static_cast<uint32_t>(random() % vocabulary.word_count())));
  }
  return vocabulary.VectorOf(words);
}

TEST(InvertedIndex, GivesTheSameAsScoringEveryKeyframe) {
  const Vocabulary vocabulary = MadeVocabulary(6, 3);
  std::mt19937_64 random(1);
  InvertedIndex index;
  std::map<KeyframeId, BowVector> keyframes;
  for (uint32_t i = 0; i < 60; ++i) {
    const KeyframeId id((i * 37) % 60);  // not in order
    keyframes[id] = RandomVector(vocabulary, random);
    index.Add(id, keyframes[id]);
    if (i % 5 == 4) {
      index.Remove(id, keyframes[id]);
      keyframes.erase(id);
    }
  }
  for (int query = 0; query < 20; ++query) {
    const BowVector vector = RandomVector(vocabulary, random);
    std::vector<std::tuple<double, KeyframeId>> expected;  // sorted by falling score, then id
    for (const auto& [id, other] : keyframes) {
      if (Score(vector, other) > 0.0) {
        expected.emplace_back(-Score(vector, other), id);
      }
    }
    std::sort(expected.begin(), expected.end());
    const std::vector<SimilarKeyframe> found = index.Query(vector);
    ASSERT_EQ(found.size(), expected.size());
    for (size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(std::tuple(-found[i].score, found[i].keyframe), expected[i]);
    }
  }
}

TEST(InvertedIndex, CountsCommonWordsAndSortsTiesById) {
  InvertedIndex index;
  index.Add(KeyframeId(3), kA);
  index.Add(KeyframeId(1), kA);
  index.Add(KeyframeId(2), kB);
  index.Add(KeyframeId(4), {{WordId(9), 1.0f}});
  const std::vector<SimilarKeyframe> found = index.Query(kA);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].keyframe, KeyframeId(1));
  EXPECT_EQ(found[1].keyframe, KeyframeId(3));
  EXPECT_EQ(found[2].keyframe, KeyframeId(2));
  EXPECT_EQ(found[0].common_words, 2u);
  EXPECT_EQ(found[2].common_words, 1u);
  EXPECT_EQ(found[0].score, 1.0);
  EXPECT_EQ(found[2].score, 0.5);
}

TEST(InvertedIndex, IsEmptyAtFirstAndAfterRemoval) {
  InvertedIndex index;
  EXPECT_TRUE(index.Query(kA).empty());
  index.Add(KeyframeId(0), kA);
  index.Add(KeyframeId(1), kB);
  index.Remove(KeyframeId(0), kA);
  EXPECT_EQ(index.Query(kA).size(), 1u);
  EXPECT_FALSE(index.postings().Contains(WordId(1)));
  index.Remove(KeyframeId(1), kB);
  EXPECT_TRUE(index.postings().empty());
  EXPECT_TRUE(index.Query(kA).empty());
}

TEST(InvertedIndex, PostingsAreSortedByKeyframe) {
  InvertedIndex index;
  for (const uint32_t id : {5u, 2u, 7u}) {
    index.Add(KeyframeId(id), kA);
  }
  EXPECT_EQ(index.postings().At(WordId(4)),
            (std::vector<Posting>{
                {KeyframeId(2), 0.75f}, {KeyframeId(5), 0.75f}, {KeyframeId(7), 0.75f}}));
}

TEST(InvertedIndex, ASnapshotDoesNotChange) {
  InvertedIndex index;
  index.Add(KeyframeId(0), kA);
  const InvertedIndex before = index.Snapshot();
  index.Add(KeyframeId(8), kA);
  index.Remove(KeyframeId(0), kA);
  ASSERT_EQ(before.Query(kA).size(), 1u);
  EXPECT_EQ(before.Query(kA)[0].keyframe, KeyframeId(0));
  ASSERT_EQ(index.Query(kA).size(), 1u);
  EXPECT_EQ(index.Query(kA)[0].keyframe, KeyframeId(8));
}

TEST(InvertedIndex, WrongEditsAreErrorsOfTheProgram) {
  InvertedIndex index;
  index.Add(KeyframeId(0), kA);
  EXPECT_THROW(index.Add(KeyframeId(0), kA), CheckError);
  EXPECT_THROW(index.Remove(KeyframeId(1), kA), CheckError);
  EXPECT_THROW(index.Remove(KeyframeId(0), {{WordId(2), 1.0f}}), CheckError);
}

}  // namespace
}  // namespace hullslam
