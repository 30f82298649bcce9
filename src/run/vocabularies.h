// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "hullslam/map_files/vocabulary_file.h"

namespace CLI {
class App;
}  // namespace CLI

namespace hullslam {

// Adds the option --vocabulary. `choice` must outlive the app.
void AddVocabularyArgument(CLI::App& app, std::filesystem::path& choice);

// The vocabulary that `--vocabulary` chooses: no vocabulary (null) for "none", the default
// vocabulary if it is empty, else the file. Throws InputError like ReadVocabulary() and
// FindDefaultVocabulary().
std::shared_ptr<const Vocabulary> ChooseVocabulary(const std::filesystem::path& choice,
                                                   bool is_quiet);

// Reads a vocabulary. Shows the progress on stderr if this takes longer than a second.
Vocabulary LoadVocabulary(const std::filesystem::path& path, bool is_quiet);

// Adds the option --form.
void AddVocabularyForm(CLI::App& app, std::string& form);

// The form in which a vocabulary file is written: `form` ("binary" or "text") if it is given, else
// the form that belongs to the extension of `path`, .bow or .txt. Throws InputError for other
// extensions.
VocabularyForm FormOf(const std::filesystem::path& path, const std::string& form);

// A line with the number of words, the shape of the tree and the hash.
std::string Describe(const Vocabulary& vocabulary);

}  // namespace hullslam
