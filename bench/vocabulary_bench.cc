// SPDX-License-Identifier: GPL-3.0-or-later
// Vocabularies: reading files, the words of a frame, and queries of the inverted index. The default
// vocabulary is used, or the file that $VOCABULARY names, such as ORBvoc.txt of ORB-SLAM2.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <vector>

#include "hullslam/bow/inverted_index.h"
#include "hullslam/bow/vocabulary.h"
#include "hullslam/map_files/vocabulary_file.h"

namespace hullslam {
namespace {

constexpr size_t kFeatures = 1000;
constexpr uint32_t kKeyframes = 1000;

std::filesystem::path File() {
  const char* const chosen = std::getenv("VOCABULARY");
  return chosen != nullptr ? chosen : FindDefaultVocabulary();
}

// A keypoint has the descriptor of a random leaf with some flipped bits, so that frames have words
// from everywhere in the tree.
std::vector<Descriptor> MakeFrame(const Vocabulary& vocabulary, std::mt19937_64& random) {
  const auto first_leaf = static_cast<size_t>(std::lower_bound(vocabulary.first_child().begin(),
                                                               vocabulary.first_child().end(),
                                                               vocabulary.node_count()) -
                                              vocabulary.first_child().begin());
  const size_t leaves = vocabulary.node_count() - first_leaf;
  std::vector<Descriptor> descriptors;
  for (size_t i = 0; i < kFeatures; ++i) {
    Descriptor descriptor = vocabulary.descriptors()[first_leaf + random() % leaves];
    for (int flip = 0; flip < 20; ++flip) {
      const uint64_t bit = random() % 256;
      descriptor[bit / 64] ^= uint64_t{1} << (bit % 64);
    }
    descriptors.push_back(descriptor);
  }
  return descriptors;
}

void Read(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(ReadVocabulary(File()).hash());
  }
}
BENCHMARK(Read)->Unit(benchmark::kMillisecond);

void WordsOfAFrame(benchmark::State& state) {
  const Vocabulary vocabulary = ReadVocabulary(File());
  std::mt19937_64 random(1);
  const std::vector<Descriptor> descriptors = MakeFrame(vocabulary, random);
  for (auto _ : state) {
    benchmark::DoNotOptimize(vocabulary.WordsOf(descriptors).data());
  }
}
BENCHMARK(WordsOfAFrame)->Unit(benchmark::kMillisecond);

void VectorOfAFrame(benchmark::State& state) {
  const Vocabulary vocabulary = ReadVocabulary(File());
  std::mt19937_64 random(1);
  const std::vector<WordId> words = vocabulary.WordsOf(MakeFrame(vocabulary, random));
  for (auto _ : state) {
    benchmark::DoNotOptimize(vocabulary.VectorOf(words).data());
  }
}
BENCHMARK(VectorOfAFrame)->Unit(benchmark::kMillisecond);

void NodesOfAFrame(benchmark::State& state) {
  const Vocabulary vocabulary = ReadVocabulary(File());
  std::mt19937_64 random(1);
  const std::vector<WordId> words = vocabulary.WordsOf(MakeFrame(vocabulary, random));
  for (auto _ : state) {
    benchmark::DoNotOptimize(vocabulary.NodesOf(words, vocabulary.levels() - 2).data());
  }
}
BENCHMARK(NodesOfAFrame)->Unit(benchmark::kMillisecond);

struct Places {
  Vocabulary vocabulary = ReadVocabulary(File());
  std::mt19937_64 random{1};
  InvertedIndex index;
  BowVector query;

  Places() {
    for (uint32_t i = 0; i < kKeyframes; ++i) {
      index.Add(KeyframeId(i), MakeVector());
    }
    query = MakeVector();
  }
  BowVector MakeVector() {
    return vocabulary.VectorOf(vocabulary.WordsOf(MakeFrame(vocabulary, random)));
  }
};

void Query(benchmark::State& state) {
  const Places places;
  size_t found = 0;
  for (auto _ : state) {
    found = places.index.Query(places.query).size();
  }
  state.counters["keyframes"] = static_cast<double>(found);
}
BENCHMARK(Query)->Unit(benchmark::kMillisecond);

// What a keyframe costs: its words are added after a snapshot was taken, and the snapshot of the
// keyframe before it is released.
void SnapshotAndAdd(benchmark::State& state) {
  Places places;
  InvertedIndex snapshot;
  for (auto _ : state) {
    snapshot = places.index.Snapshot();
    places.index.Add(KeyframeId(kKeyframes), places.query);
    state.PauseTiming();
    places.index.Remove(KeyframeId(kKeyframes), places.query);
    state.ResumeTiming();
  }
}
BENCHMARK(SnapshotAndAdd)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hullslam

BENCHMARK_MAIN();
