// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/vocabularies.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <chrono>
#include <fstream>
#include <span>
#include <string>
#include <system_error>

#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "run/messages.h"

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

bool IsVocabularyFile(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return false;
  }
  std::ifstream file(path, std::ios::binary);
  std::string begin(200, '\0');
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<size_t>(file.gcount()));
  if (Vocabulary::IsBinary(std::as_bytes(std::span(begin)))) {
    return true;
  }
  // The text form begins with four whole numbers: branching, levels, score and weight.
  const std::string line = begin.substr(0, begin.find_first_of("\r\n"));
  Eigen::Vector4d numbers;
  return line.find_first_not_of("0123456789 \t") == std::string::npos &&
         ParseFinites(line, numbers);
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
