// SPDX-License-Identifier: GPL-3.0-or-later
// How well a vocabulary finds places again. Prints one line per vocabulary.
//
//   place_bench VOCABULARY... -- SEQUENCE[:half]...    (:half takes the second half only)
//
// Every 10th image with a true pose of all sequences is in one index. The image at the front of
// each query's list counts as right if it shows the same place: it is of the same sequence, at most
// 0.3 m and 20 degrees away. Images within 1 s of the query are left out, and so are queries for
// which nothing is right.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "features/extractor.h"
#include "hullslam/bow/inverted_index.h"
#include "hullslam/map_files/vocabulary_file.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/util/error.h"
#include "images/image_file.h"

namespace hullslam {
namespace {

struct View {
  size_t sequence = 0;
  double timestamp = 0.0;  // s
  Rigid3 world_from_cam;
  std::vector<Descriptor> descriptors;
};

// Adds every 10th image; of the second half only if the path ends with ":half".
void AddViews(std::string path, size_t number, std::vector<View>& views) {
  constexpr std::string_view kHalf = ":half";
  const bool is_half = path.ends_with(kHalf);
  if (is_half) {
    path.resize(path.size() - kHalf.size());
  }
  const ImageSequence sequence = OpenTumSequence(path, {});
  const Trajectory truth = ReadGroundtruth(sequence).value();
  FeatureExtractor extractor{FeatureOptions()};
  for (size_t i = is_half ? sequence.frames.size() / 2 : 0; i < sequence.frames.size(); i += 10) {
    const double stamp = sequence.frames[i].timestamp;
    const auto pose = std::lower_bound(
        truth.begin(), truth.end(), stamp,
        [](const StampedPose& a, double timestamp) { return a.timestamp < timestamp; });
    if (pose != truth.end() && std::abs(pose->timestamp - stamp) < 0.02) {
      views.push_back({number, stamp, pose->world_from_cam,
                       extractor.Extract(ReadGreyImage(sequence.frames[i].image)).descriptors});
    }
  }
}

bool IsNear(const View& a, const View& b) {
  const double metres = (a.world_from_cam.translation - b.world_from_cam.translation).norm();
  const double radians = a.world_from_cam.rotation.angularDistance(b.world_from_cam.rotation);
  return a.sequence == b.sequence && metres < 0.3 && radians < 20.0 * std::numbers::pi / 180.0;
}

bool IsLeftOut(const View& query, const View& other) {
  return query.sequence == other.sequence && std::abs(query.timestamp - other.timestamp) <= 1.0;
}

void Judge(const std::string& path, const std::vector<View>& views) {
  const Vocabulary vocabulary = ReadVocabulary(path);
  InvertedIndex index;
  std::vector<BowVector> vectors;
  for (const View& view : views) {
    vectors.push_back(vocabulary.VectorOf(vocabulary.WordsOf(view.descriptors)));
    index.Add(KeyframeId(static_cast<uint32_t>(vectors.size() - 1)), vectors.back());
  }
  size_t queries = 0;
  size_t right = 0;
  size_t right_of_five = 0;
  for (size_t q = 0; q < views.size(); ++q) {
    const bool has_place = std::any_of(views.begin(), views.end(), [&](const View& other) {
      return !IsLeftOut(views[q], other) && IsNear(views[q], other);
    });
    if (!has_place) {
      continue;
    }
    ++queries;
    std::vector<bool> hits;
    for (const SimilarKeyframe& similar : index.Query(vectors[q])) {
      const View& other = views[similar.keyframe.value];
      if (hits.size() < 5 && !IsLeftOut(views[q], other)) {
        hits.push_back(IsNear(views[q], other));
      }
    }
    right += !hits.empty() && hits.front() ? 1 : 0;
    right_of_five += std::find(hits.begin(), hits.end(), true) != hits.end() ? 1 : 0;
  }
  const auto percent = [&](size_t count) {
    return 100.0 * static_cast<double>(count) / static_cast<double>(std::max<size_t>(queries, 1));
  };
  fmt::print("{}: {} words, {} views, {} queries, recall@1 {:.1f} %, recall@5 {:.1f} %\n", path,
             vocabulary.word_count(), views.size(), queries, percent(right),
             percent(right_of_five));
}

int Run(const std::vector<std::string>& arguments) {
  const auto middle = std::find(arguments.begin(), arguments.end(), "--");
  if (middle == arguments.end()) {
    fmt::print(stderr, "usage: place_bench VOCABULARY... -- SEQUENCE[:half]...\n");
    return 2;
  }
  std::vector<View> views;
  for (auto sequence = middle + 1; sequence != arguments.end(); ++sequence) {
    AddViews(*sequence, static_cast<size_t>(sequence - middle), views);
  }
  for (auto vocabulary = arguments.begin(); vocabulary != middle; ++vocabulary) {
    Judge(*vocabulary, views);
  }
  return 0;
}

}  // namespace
}  // namespace hullslam

int main(int argc, char** argv) {
  try {
    return hullslam::Run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
}
