// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/vocabulary_form.h"

#include <fmt/format.h>

#include "hullslam/util/error.h"

namespace hullslam {

void AddVocabularyForm(CLI::App& app, std::string& form) {
  app.add_option("--form", form,
                 "form of the output: binary or text (default: by its extension, .bow or .txt)")
      ->check(CLI::IsMember({"binary", "text"}).description(""));
}

VocabularyForm FormOf(const std::filesystem::path& path, const std::string& form) {
  const std::string extension = path.extension().string();
  if (form == "binary" || (form.empty() && extension == ".bow")) {
    return VocabularyForm::kBinary;
  }
  if (form == "text" || (form.empty() && extension == ".txt")) {
    return VocabularyForm::kText;
  }
  throw InputError(fmt::format(
      "{}: the extension '{}' tells no form, expected .bow or .txt, or --form binary|text",
      path.string(), extension));
}

std::string Describe(const Vocabulary& vocabulary) {
  return fmt::format("{} words, branching {}, {} levels, hash {:016x}", vocabulary.word_count(),
                     vocabulary.branching(), vocabulary.levels(), vocabulary.hash());
}

}  // namespace hullslam
