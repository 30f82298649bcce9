// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/chunk_cache.h"

#include <gtest/gtest.h>

#include <string>

namespace hullslam {
namespace {

TEST(ChunkCacheTest, KeepsTheChunksThatWereUsedLast) {
  ChunkCache cache;
  int loads = 0;
  const auto get = [&](uint64_t position) {
    return cache.Get(position, [&] {
      ++loads;
      return std::to_string(position);
    });
  };
  for (const uint64_t position : {1, 2, 3, 1, 2, 1}) {
    EXPECT_EQ(get(position), std::to_string(position));
  }
  EXPECT_EQ(loads, 3);
  get(4);  // takes the place of 3
  get(1);
  get(2);
  EXPECT_EQ(loads, 4);
  get(3);
  EXPECT_EQ(loads, 5);
}

}  // namespace
}  // namespace hullslam
