// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "hullslam/bow/bow_vector.h"
#include "hullslam/util/cow_table.h"
#include "hullslam/util/id.h"

namespace hullslam {

// A keyframe that contains a word.
struct Posting {
  KeyframeId keyframe;
  float weight = 0.0f;  // weight of the word in the keyframe's vector

  friend bool operator==(const Posting&, const Posting&) = default;
};

// A keyframe that looks like a queried image.
struct SimilarKeyframe {
  KeyframeId keyframe;
  uint32_t common_words = 0;  // at least 1
  double score = 0.0;         // similarity to the image, 0 to 1; see Score()
};

// Stores for each word the keyframes that contain it. Like the map, it is a value whose snapshots
// share memory until one of them is changed.
class InvertedIndex {
 public:
  // Each chunk has one value. The words of an image are scattered over the whole table, so with
  // larger chunks each changed word would copy many others.
  using Table = CowTable<WordId, std::vector<Posting>, 1>;

  InvertedIndex Snapshot();

  // Throws CheckError if the keyframe already has one of the words.
  void Add(KeyframeId keyframe, const BowVector& vector);
  // Removes the keyframe. `vector` must be the one that was added. Throws CheckError if the
  // keyframe lacks one of its words.
  void Remove(KeyframeId keyframe, const BowVector& vector);

  // All keyframes that have a word in common with `vector`: the highest score first, equal scores
  // by increasing id.
  std::vector<SimilarKeyframe> Query(const BowVector& vector) const;

  // The keyframes of each word, by increasing id. Words without keyframes have no entry.
  const Table& postings() const { return postings_; }

 private:
  Table postings_;
  uint32_t keyframe_end_ = 0;  // larger than the ids of all keyframes that were added
};

}  // namespace hullslam
