// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "hullslam/map_files/vocabulary_file.h"

namespace hullslam {

// Adds the option --form.
void AddVocabularyForm(CLI::App& app, std::string& form);

// The form of a vocabulary file to be written: `form` ("binary" or "text") if it is given, else
// that of the extension of `path`: .bow or .txt. Throws InputError for other extensions.
VocabularyForm FormOf(const std::filesystem::path& path, const std::string& form);

// One line: words, shape and hash.
std::string Describe(const Vocabulary& vocabulary);

}  // namespace hullslam
