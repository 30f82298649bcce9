// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/function_clones.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hullslam {
namespace {

HULLSLAM_FUNCTION_CLONES
void SaturatedDifferences(const uint8_t* a, const uint8_t* b, size_t count, uint8_t* result) {
  for (size_t i = 0; i < count; ++i) {
    result[i] = a[i] > b[i] ? static_cast<uint8_t>(a[i] - b[i]) : uint8_t{0};
  }
}

// The clone that the loader chose gives the same results as plain code, also for counts that are no
// multiple of the vector width.
TEST(FunctionClones, GiveTheSameResultsAsPlainCode) {
  for (const size_t count : {0u, 1u, 31u, 32u, 1003u}) {
    std::vector<uint8_t> a(count);
    std::vector<uint8_t> b(count);
    for (size_t i = 0; i < count; ++i) {
      a[i] = static_cast<uint8_t>(37 * i);
      b[i] = static_cast<uint8_t>(91 * i + 5);
    }
    std::vector<uint8_t> result(count);
    SaturatedDifferences(a.data(), b.data(), count, result.data());
    for (size_t i = 0; i < count; ++i) {
      const int difference = static_cast<int>(a[i]) - static_cast<int>(b[i]);
      EXPECT_EQ(result[i], difference > 0 ? difference : 0);
    }
  }
}

}  // namespace
}  // namespace hullslam
