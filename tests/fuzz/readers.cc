// SPDX-License-Identifier: GPL-3.0-or-later
#include "fuzz/readers.h"

#include <algorithm>
#include <string>
#include <vector>

#include "fuzz/fuzzed_input.h"

namespace hullslam {
namespace {

// The constants of other files may be made before those of this one.
std::vector<FuzzedReader>& AllReaders() {
  static std::vector<FuzzedReader> readers;
  return readers;
}

}  // namespace

KnownReaders::KnownReaders(std::span<const FuzzedReader> readers) {
  AllReaders().insert(AllReaders().end(), readers.begin(), readers.end());
}

const FuzzedReader& FindFuzzedReader(std::string_view name) {
  const auto found = std::ranges::find(AllReaders(), name, &FuzzedReader::name);
  if (found == AllReaders().end()) {
    Finding("no reader " + std::string(name));
  }
  return *found;
}

}  // namespace hullslam
