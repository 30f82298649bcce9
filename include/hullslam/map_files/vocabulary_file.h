// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "hullslam/bow/vocabulary.h"
#include "hullslam/util/cancellation.h"

namespace hullslam {

// Reads a vocabulary in the binary form of HullSLAM or in the text format of DBoW2 and ORB-SLAM2
// (docs/maps.md). The content tells which of the two it is. The file may change afterwards.
// Reading text takes seconds; `on_progress` is told how many MB are done. Throws InputError that
// names the file, the line, and what was expected.
Vocabulary ReadVocabulary(const std::filesystem::path& path,
                          const ProgressCallback& on_progress = {});

// Whether the file begins like a vocabulary of either form. False for a file that cannot be read.
bool IsVocabularyFile(const std::filesystem::path& path);

enum class VocabularyForm { kBinary, kText };

// Writes like WriteFileAtomically(): the file is complete or not there at all. Reading it gives a
// vocabulary with the same hash.
void WriteVocabulary(const std::filesystem::path& path, const Vocabulary& vocabulary,
                     VocabularyForm form);

// The vocabulary that comes with HullSLAM: $HULLSLAM_VOCABULARY, else the file
// ../Vocabulary/hullslam.bow beside $HULLSLAM_CONFIG, else the file of the installation, else the
// file of the source tree. Throws InputError if there is none of them.
std::filesystem::path FindDefaultVocabulary();

}  // namespace hullslam
