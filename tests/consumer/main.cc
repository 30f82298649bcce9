// SPDX-License-Identifier: GPL-3.0-or-later
// The program of a user, which links the whole installed library.
#include <filesystem>

#include "core.h"
#include "hullslam/map_files/vocabulary_file.h"

int main() {
  bool good = CoreWorks();
  good &= Report(std::filesystem::is_directory(HULLSLAM_CONFIG_DIR), "settings are installed");
  good &= Report(hullslam::ReadVocabulary(HULLSLAM_VOCABULARY).word_count() > 1000,
                 "the default vocabulary is installed");
  return good ? 0 : 1;
}
