// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/vocabularies.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <string>

#include "hullslam/util/error.h"
#include "run/program.h"

namespace hullslam {

void AddVocabularyArgument(CLI::App& app, std::filesystem::path& choice) {
  app.add_option("--vocabulary", choice,
                 "vocabulary of visual words: a binary file, a text file of ORB-SLAM2, or none "
                 "(default: the one that comes with HullSLAM)");
}

std::shared_ptr<const Vocabulary> ChooseVocabulary(const std::filesystem::path& choice,
                                                   bool is_quiet) {
  if (choice == "none") {
    return nullptr;
  }
  return std::make_shared<const Vocabulary>(
      LoadVocabulary(choice.empty() ? FindDefaultVocabulary() : choice, is_quiet));
}

Vocabulary LoadVocabulary(const std::filesystem::path& path, bool is_quiet) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::seconds kStep(1);
  Clock::time_point shown = Clock::now();
  return ReadVocabulary(path, [&](int done, int most) {
    if (!is_quiet && Clock::now() - shown > kStep) {
      shown = Clock::now();
      PrintError("reading {}: {} of {} MB\n", path.string(), done, most);
    }
  });
}

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
      "{}: the extension '{}' belongs to no form, expected .bow or .txt, or --form binary|text",
      path.string(), extension));
}

std::string Describe(const Vocabulary& vocabulary) {
  return fmt::format("{} words, branching {}, {} levels, hash {:016x}", vocabulary.word_count(),
                     vocabulary.branching(), vocabulary.levels(), vocabulary.hash());
}

}  // namespace hullslam
