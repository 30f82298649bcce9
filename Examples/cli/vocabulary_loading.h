// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>

#include "hullslam/bow/vocabulary.h"

namespace hullslam {

// Reads a vocabulary and shows the progress on stderr if that takes longer than a second.
Vocabulary LoadVocabulary(const std::filesystem::path& path, bool is_quiet);

// What `--vocabulary` stands for: no vocabulary (null) if it is "none", the default vocabulary if
// it is empty, else the file. Throws InputError like ReadVocabulary() and FindDefaultVocabulary().
std::shared_ptr<const Vocabulary> ChooseVocabulary(const std::filesystem::path& choice,
                                                   bool is_quiet);

}  // namespace hullslam
