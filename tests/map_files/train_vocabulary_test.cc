// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_files/train_vocabulary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "hullslam/util/check.h"
#include "support/made_vocabulary.h"
#include "util/task_runner.h"

namespace hullslam {
namespace {

// Makes images that show points chosen at random from `points` points. Each descriptor is that of
// its point with `flips` flipped bits.
std::vector<std::vector<Descriptor>> MakeImages(size_t points, size_t images, size_t keypoints,
                                                int flips) {
  std::mt19937_64 random(11);
  std::vector<Descriptor> seen;
  for (size_t i = 0; i < points; ++i) {
    seen.push_back(RandomDescriptor(random));
  }
  std::vector<std::vector<Descriptor>> result(images);
  for (auto& image : result) {
    for (size_t i = 0; i < keypoints; ++i) {
      Descriptor& descriptor = image.emplace_back(seen[random() % points]);
      for (int flip = 0; flip < flips; ++flip) {
        const uint64_t bit = random() % 256;
        descriptor[bit / 64] ^= uint64_t{1} << (bit % 64);
      }
    }
  }
  return result;
}

Vocabulary Train(const std::vector<std::vector<Descriptor>>& images,
                 const VocabularyTraining& options) {
  SerialRunner runner;
  return *TrainVocabulary(images, options, runner);
}

TEST(TrainVocabulary, HasTheShapeThatWasAskedFor) {
  const Vocabulary vocabulary = Train(MakeImages(2000, 20, 300, 5), {.branching = 6, .levels = 3});
  EXPECT_EQ(vocabulary.branching(), 6);
  EXPECT_EQ(vocabulary.levels(), 3);
  EXPECT_LE(vocabulary.word_count(), 216u);
  EXPECT_GT(vocabulary.word_count(), 180u);
}

// Views of a point differ in at most 16 bits, those of different points in about 128.
TEST(TrainVocabulary, ViewsOfAPointShareAWord) {
  const auto images = MakeImages(16, 30, 40, 8);
  const Vocabulary vocabulary = Train(images, {.branching = 16, .levels = 1});
  EXPECT_GE(vocabulary.word_count(), 12u);
  for (const auto& image : images) {
    for (const Descriptor& descriptor : image) {
      const bool is_same_point = HammingDistance(descriptor, images[0][0]) < 50;
      const std::vector<Descriptor> both = {descriptor, images[0][0]};
      const std::vector<WordId> words = vocabulary.WordsOf(both);
      EXPECT_TRUE(!is_same_point || words[0] == words[1]);
    }
  }
}

TEST(TrainVocabulary, WeightsAreInverseDocumentFrequencies) {
  // Descriptor a is in all four images, b in two, and c in one, several times.
  const Descriptor a{0, 0, 0, 0};
  const Descriptor b{~uint64_t{0}, 0, 0, 0};
  const Descriptor c{0, ~uint64_t{0}, ~uint64_t{0}, 0};
  const Vocabulary vocabulary =
      Train({{a, b}, {a, a, c, c, c}, {b, a}, {a}}, {.branching = 3, .levels = 2});
  ASSERT_EQ(vocabulary.word_count(), 3u);
  const std::vector<Descriptor> all = {a, b, c};
  const std::vector<WordId> words = vocabulary.WordsOf(all);
  EXPECT_EQ(vocabulary.weights()[words[0].value], 0.0f);
  EXPECT_FLOAT_EQ(vocabulary.weights()[words[1].value], std::log(2.0f));
  EXPECT_FLOAT_EQ(vocabulary.weights()[words[2].value], std::log(4.0f));
}

TEST(TrainVocabulary, DependsOnTheSeedButNotOnThreads) {
  const auto images = MakeImages(3000, 20, 500, 10);
  ParallelRunner parallel(3);
  const Vocabulary vocabulary = Train(images, {.branching = 5, .levels = 4});
  EXPECT_EQ(TrainVocabulary(images, {.branching = 5, .levels = 4}, parallel)->hash(),
            vocabulary.hash());
  EXPECT_NE(Train(images, {.branching = 5, .levels = 4, .seed = 1}).hash(), vocabulary.hash());
}

// Equal descriptors cannot be divided: the branch ends early.
TEST(TrainVocabulary, FewDescriptorsGiveFewWords) {
  const Vocabulary one = Train({{Descriptor{1, 2, 3, 4}}}, {});
  EXPECT_EQ(one.word_count(), 1u);
  const Vocabulary two =
      Train({{Descriptor{1, 2, 3, 4}, Descriptor{7, 2, 3, 4}}, {Descriptor{1, 2, 3, 4}}}, {});
  EXPECT_EQ(two.word_count(), 2u);
}

TEST(TrainVocabulary, EndsEarlyIfItIsAskedTo) {
  SerialRunner runner;
  Cancellation cancellation;
  std::vector<int> levels;
  const auto images = MakeImages(500, 10, 100, 5);
  const auto result = TrainVocabulary(images, {.branching = 3, .levels = 4}, runner, &cancellation,
                                      [&](int done, int most) {
                                        EXPECT_EQ(most, 4);
                                        levels.push_back(done);
                                        if (done == 2) {
                                          cancellation.Request();
                                        }
                                      });
  EXPECT_FALSE(result);
  EXPECT_EQ(levels, (std::vector<int>{1, 2}));
}

TEST(TrainVocabulary, WrongOptionsAreErrorsOfTheProgram) {
  const std::vector<std::vector<Descriptor>> images = {{Descriptor{}}};
  EXPECT_THROW(Train(images, {.branching = 1}), CheckError);
  EXPECT_THROW(Train(images, {.levels = 0}), CheckError);
  EXPECT_THROW(Train(images, {.levels = 11}), CheckError);
  EXPECT_THROW(Train({}, {}), CheckError);
  EXPECT_THROW(Train({{}, {}}, {}), CheckError);
}

}  // namespace
}  // namespace hullslam
