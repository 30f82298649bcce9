// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/bow/inverted_index.h"

#include <algorithm>
#include <tuple>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

// The posting of a keyframe in the list of a word, or the position where it would be inserted.
auto FindPosting(auto& postings, KeyframeId keyframe) {
  return std::lower_bound(
      postings.begin(), postings.end(), keyframe,
      [](const Posting& posting, KeyframeId id) { return posting.keyframe < id; });
}

}  // namespace

InvertedIndex InvertedIndex::Snapshot() {
  InvertedIndex copy;
  copy.postings_ = postings_.Snapshot();
  copy.keyframe_end_ = keyframe_end_;
  return copy;
}

void InvertedIndex::Add(KeyframeId keyframe, const BowVector& vector) {
  for (const auto& [word, weight] : vector) {
    if (!postings_.Contains(word)) {
      postings_.Put(word, {{keyframe, weight}});
      continue;
    }
    std::vector<Posting>& list = postings_.Mutable(word);
    const auto posting = FindPosting(list, keyframe);
    Check(posting == list.end() || posting->keyframe != keyframe,
          "the keyframe already has the word");
    list.insert(posting, {keyframe, weight});
  }
  keyframe_end_ = std::max(keyframe_end_, keyframe.value + 1);
}

void InvertedIndex::Remove(KeyframeId keyframe, const BowVector& vector) {
  for (const auto& [word, weight] : vector) {
    const std::vector<Posting>* const old = postings_.Find(word);
    Check(old != nullptr, "no keyframe contains the word");
    const auto posting = FindPosting(*old, keyframe);
    Check(posting != old->end() && posting->keyframe == keyframe,
          "the keyframe does not contain the word");
    if (old->size() == 1) {
      postings_.Erase(word);
    } else {
      const auto index = posting - old->begin();
      std::vector<Posting>& list = postings_.Mutable(word);
      list.erase(list.begin() + index);
    }
  }
}

std::vector<SimilarKeyframe> InvertedIndex::Query(const BowVector& vector) const {
  struct Sum {
    double score = 0.0;
    uint32_t common_words = 0;
  };
  std::vector<Sum> sums(keyframe_end_);
  for (const auto& [word, weight] : vector) {
    const std::vector<Posting>* const list = postings_.Find(word);
    if (list == nullptr) {
      continue;
    }
    for (const Posting& posting : *list) {
      Sum& sum = sums[posting.keyframe.value];
      sum.score += static_cast<double>(std::min(weight, posting.weight));
      ++sum.common_words;
    }
  }
  std::vector<SimilarKeyframe> similar;
  for (uint32_t i = 0; i < keyframe_end_; ++i) {
    if (sums[i].common_words > 0) {
      similar.push_back({KeyframeId(i), sums[i].common_words, sums[i].score});
    }
  }
  std::sort(similar.begin(), similar.end(), [](const auto& a, const auto& b) {
    return std::tie(b.score, a.keyframe) < std::tie(a.score, b.keyframe);
  });
  return similar;
}

}  // namespace hullslam
