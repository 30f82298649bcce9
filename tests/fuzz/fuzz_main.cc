// SPDX-License-Identifier: GPL-3.0-or-later
// The entry function of libFuzzer for the reader HULLSLAM_FUZZ_READER.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/readers.h"

// NOLINTNEXTLINE(readability-identifier-naming): the name is libFuzzer's
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const hullslam::FuzzedReader& reader = hullslam::FindFuzzedReader(HULLSLAM_FUZZ_READER);
  reader.read({reinterpret_cast<const char*>(data), size});
  return 0;
}
