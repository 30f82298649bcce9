// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/util/id.h"

namespace hullslam {

// A visual word: the number of a leaf of the vocabulary.
using WordId = Id<struct WordTag>;

struct WeightedWord {
  WordId word;
  float weight = 0.0f;  // above 0

  friend bool operator==(const WeightedWord&, const WeightedWord&) = default;
};

// The bag of words of an image: its words by increasing id, with weights whose sum is 1. Empty for
// an image without words.
using BowVector = std::vector<WeightedWord>;

// The similarity of two images: 1 - |v - w|_1 / 2 (Galvez-Lopez and Tardos 2012), where |.|_1 is
// the sum of absolute differences over all words. It is 0 if the images have no word in common and
// 1 if the vectors are equal. Because the weights add up to 1, it equals the sum of min(v_i, w_i)
// over the common words. It is 0 if a vector is empty.
double Score(const BowVector& v, const BowVector& w);

}  // namespace hullslam
