// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map_files/vocabulary_file.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "files/paths.h"
#include "files/read_file.h"
#include "files/staged_file.h"
#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "map_files/vocabulary_text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostVocabularyBytes = 1'000'000'000;

// A variable of the environment; empty if it is not set.
std::string Variable(const char* name) {
  // This library changes the environment only when a video is opened, so reading it is safe.
  // NOLINTNEXTLINE(concurrency-mt-unsafe)
  const char* const value = std::getenv(name);
  return value != nullptr ? value : "";
}

std::string_view AsText(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

Vocabulary ReadVocabulary(const fs::path& path, const ProgressCallback& on_progress) {
  auto content = std::make_shared<const std::string>(ReadFile(path, kMostVocabularyBytes));
  const std::string_view text = *content;
  const std::span<const std::byte> bytes = std::as_bytes(std::span(text));
  if (Vocabulary::IsBinary(bytes)) {
    return Vocabulary::View(bytes, std::move(content), path.string());
  }
  if (text.empty()) {
    throw InputError(path.string() + ": is empty, expected a vocabulary");
  }
  if (text.front() < '0' || text.front() > '9') {
    throw InputError(path.string() +
                     ": is not a vocabulary, expected the binary form of HullSLAM or the text "
                     "format of DBoW2");
  }
  return ParseVocabularyText(text, path, on_progress);
}

bool IsVocabularyFile(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
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

void WriteVocabulary(const fs::path& path, const Vocabulary& vocabulary, VocabularyForm form) {
  if (form == VocabularyForm::kBinary) {
    WriteFileAtomically(path, AsText(vocabulary.bytes()));
  } else {
    WriteFileAtomically(path, FormatVocabularyText(vocabulary));
  }
}

fs::path FindDefaultVocabulary() {
  std::error_code error;
  if (const std::string chosen = Variable("HULLSLAM_VOCABULARY"); !chosen.empty()) {
    if (!fs::is_regular_file(chosen, error)) {
      throw InputError("HULLSLAM_VOCABULARY: '" + chosen + "' is not a file");
    }
    return chosen;
  }
  const fs::path name = fs::path("Vocabulary") / "hullslam.bow";
  if (const std::string config = Variable("HULLSLAM_CONFIG"); !config.empty()) {
    const fs::path beside = fs::path(config) / ".." / name;
    if (fs::is_regular_file(beside, error)) {
      return beside;
    }
  }
  return FindData(name,
                  "expected the default vocabulary there; set HULLSLAM_VOCABULARY or give "
                  "--vocabulary FILE|none");
}

}  // namespace hullslam
