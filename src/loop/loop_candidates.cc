// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/loop_candidates.h"

#include <algorithm>

#include "map/covisibility.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

constexpr size_t kGroup = 10;        // covisible keyframes that belong to one place
constexpr size_t kSupporters = 5;    // keyframes that may support a candidate
constexpr double kCommonShare = 0.8;  // of the most common words; as the next one: Mur-Artal and
constexpr double kScoreShare = 0.75;  // Tardos 2014

BowVector VectorOf(const Map& map, const Vocabulary& vocabulary, KeyframeId keyframe) {
  return vocabulary.VectorOf(map.keyframes().At(keyframe).frame->words);
}

// The keyframe and those it shares most landmarks with.
std::vector<KeyframeId> GroupOf(const Map& map, KeyframeId keyframe) {
  std::vector<KeyframeId> group = BestCovisible(map.keyframes().At(keyframe), kGroup);
  group.push_back(keyframe);
  return group;
}

// Everything within two steps of the covisibility graph.
IdSet<KeyframeId> ConnectedTo(const Map& map, KeyframeId keyframe) {
  IdSet<KeyframeId> connected;
  connected.Insert(keyframe);
  for (const Covisible& first : map.keyframes().At(keyframe).covisible) {
    connected.Insert(first.keyframe);
    for (const Covisible& second : map.keyframes().At(first.keyframe).covisible) {
      connected.Insert(second.keyframe);
    }
  }
  return connected;
}

// What a keyframe looks like, other than what it is connected to.
std::vector<SimilarKeyframe> FindSimilar(const Map& map, const Vocabulary& vocabulary,
                                         KeyframeId query) {
  const BowVector vector = VectorOf(map, vocabulary, query);
  double least = 1.0;
  for (const KeyframeId neighbour : BestCovisible(map.keyframes().At(query), kGroup)) {
    least = std::min(least, Score(vector, VectorOf(map, vocabulary, neighbour)));
  }
  std::vector<SimilarKeyframe> similar = map.words().Query(vector);
  const IdSet<KeyframeId> connected = ConnectedTo(map, query);
  std::erase_if(similar,
                [&](const SimilarKeyframe& s) { return connected.Contains(s.keyframe); });
  uint32_t most_common = 0;
  for (const SimilarKeyframe& s : similar) {
    most_common = std::max(most_common, s.common_words);
  }
  std::erase_if(similar, [&](const SimilarKeyframe& s) {
    return s.score < least || s.common_words < kCommonShare * most_common;
  });
  return similar;
}

// The sum of the scores of those in `similar` that belong to the keyframe's group.
double GroupScore(const Map& map, KeyframeId keyframe,
                  const std::vector<SimilarKeyframe>& similar) {
  IdSet<KeyframeId> group;
  for (const KeyframeId member : GroupOf(map, keyframe)) {
    group.Insert(member);
  }
  double sum = 0.0;
  for (const SimilarKeyframe& s : similar) {
    sum += group.Contains(s.keyframe) ? s.score : 0.0;
  }
  return sum;
}

// The best of each group whose scores add up to nearly as much as those of the best group.
std::vector<KeyframeId> BestOfGroups(const Map& map, const std::vector<SimilarKeyframe>& similar) {
  std::vector<double> sums;
  for (const SimilarKeyframe& s : similar) {
    sums.push_back(GroupScore(map, s.keyframe, similar));
  }
  const double best = sums.empty() ? 0.0 : *std::max_element(sums.begin(), sums.end());
  std::vector<KeyframeId> chosen;
  IdSet<KeyframeId> covered;
  for (size_t i = 0; i < similar.size(); ++i) {  // the most similar first
    if (sums[i] < kScoreShare * best || covered.Contains(similar[i].keyframe)) {
      continue;
    }
    chosen.push_back(similar[i].keyframe);
    for (const KeyframeId member : GroupOf(map, similar[i].keyframe)) {
      covered.Insert(member);
    }
  }
  return chosen;
}

}  // namespace

std::vector<KeyframeId> FindLoopCandidates(const Map& map, const Vocabulary& vocabulary,
                                           KeyframeId query, int min_supporters) {
  std::vector<KeyframeId> candidates = BestOfGroups(map, FindSimilar(map, vocabulary, query));
  if (candidates.empty() || min_supporters == 0) {
    return candidates;
  }
  std::vector<IdSet<KeyframeId>> seen_by_supporters;
  for (const KeyframeId supporter : BestCovisible(map.keyframes().At(query), kSupporters)) {
    IdSet<KeyframeId>& seen = seen_by_supporters.emplace_back();
    for (const SimilarKeyframe& s : FindSimilar(map, vocabulary, supporter)) {
      seen.Insert(s.keyframe);
    }
  }
  std::erase_if(candidates, [&](KeyframeId candidate) {
    const std::vector<KeyframeId> group = GroupOf(map, candidate);
    const auto supports = [&](const IdSet<KeyframeId>& seen) {
      return std::any_of(group.begin(), group.end(),
                         [&](KeyframeId member) { return seen.Contains(member); });
    };
    return std::count_if(seen_by_supporters.begin(), seen_by_supporters.end(), supports) <
           min_supporters;
  });
  return candidates;
}

}  // namespace hullslam
