// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "synthetic/suite.h"

namespace hullslam::synthetic {

struct SuiteOptions {
  int frames = kSuiteFrames;  // of each sequence, at least 2
  uint64_t seed = 0;
  std::vector<std::string> only = {};  // names of sequences; empty for all
  bool force = false;                  // allows replacing a folder that an earlier run wrote
  double stereo_baseline = 0.0;        // m, as in SequenceOptions
  int threads = 0;                     // 0: as many as the CPU supports
};

// Renders sequences of the suite, each into a folder with its name, and writes suite.json, which
// describes them (docs/synthetic.md). Everything appears in `folder` at the end, so a failed run
// leaves nothing. The same options give the same bytes with any number of threads.
//
// `progress` is called after each frame with the name of the sequence and the number of finished
// frames of all sequences, by one thread at a time; it returns false to stop. Returns whether the
// suite was completed. Throws InputError if `folder` exists and may not be replaced, if it cannot
// be written, or if a name of `only` is unknown.
bool WriteSuite(const std::filesystem::path& folder, const SuiteOptions& options,
                const std::function<bool(std::string_view, int)>& progress);

}  // namespace hullslam::synthetic
