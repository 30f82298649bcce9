// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/packed_array.h"

#include <gtest/gtest.h>

#include <vector>

namespace hullslam {
namespace {

// 1.0f has the bytes 00 00 80 3f, and 258 has 02 01 00 00.
TEST(PackedArray, HasTheLeastSignificantByteFirst) {
  EXPECT_EQ(PackArray(std::vector<float>{1.0f}), (nlohmann::json{{"f32", "AACAPw=="}}));
  EXPECT_EQ(PackArray(std::vector<uint32_t>{258}), (nlohmann::json{{"u32", "AgEAAA=="}}));
  EXPECT_EQ(PackArray(std::vector<uint8_t>{1, 255}), (nlohmann::json{{"u8", "Af8="}}));
  EXPECT_EQ(PackArray(std::vector<float>()), (nlohmann::json{{"f32", ""}}));
}

}  // namespace
}  // namespace hullslam
