// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/vocabulary_loading.h"

#include <chrono>

#include "cli/messages.h"
#include "hullslam/map_files/vocabulary_file.h"

namespace hullslam {

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

std::shared_ptr<const Vocabulary> ChooseVocabulary(const std::filesystem::path& choice,
                                                   bool is_quiet) {
  if (choice == "none") {
    return nullptr;
  }
  return std::make_shared<const Vocabulary>(
      LoadVocabulary(choice.empty() ? FindDefaultVocabulary() : choice, is_quiet));
}

}  // namespace hullslam
