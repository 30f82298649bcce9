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
// a node: the number of its parent, 1 for a leaf or 0, 32 bytes of its descriptor, its weight. The
// root is node 0 and has no line; the node of the n-th line after the first has number n.

// `on_progress` is told how many MB of `text` are done. Throws InputError "PATH:LINE: what".
Vocabulary ParseVocabularyText(std::string_view text, const std::filesystem::path& path,
                               const ProgressCallback& on_progress);

// Reading it gives the same bits again.
std::string FormatVocabularyText(const Vocabulary& vocabulary);

}  // namespace hullslam
