// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "hullslam/bow/vocabulary.h"
#include "hullslam/util/cancellation.h"

namespace hullslam {

// The text format of DBoW2 (Galvez-Lopez and Tardos 2012), which ORB-SLAM2 uses. The first line is
// "k L scoring weighting"; scoring and weighting must be 0 (L1 norm, tf-idf). Every further line is
// a node: the number of its parent, 1 for a leaf or 0 for another node, the 32 bytes of its
// descriptor, and its weight. The root is node 0 and has no line. Node n is on the n-th line after
// the first.

// Parses the text. `on_progress` is called with the number of parsed MB. Throws InputError
// "PATH:LINE: REASON".
Vocabulary ParseVocabularyText(std::string_view text, const std::filesystem::path& path,
                               const ProgressCallback& on_progress);

// The text of a vocabulary. Parsing it gives the same bits again.
std::string FormatVocabularyText(const Vocabulary& vocabulary);

}  // namespace hullslam
