// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/hash.h"

#include <gtest/gtest.h>

#include <bitset>
#include <set>
#include <string>

namespace hullslam {
namespace {

// Values of the authors' test vectors.
TEST(Fnv1a, HasThePublishedValues) {
  EXPECT_EQ(Fnv1a<uint32_t>(""), 0x811c9dc5U);
  EXPECT_EQ(Fnv1a<uint32_t>("foobar"), 0xbf9cf968U);
  EXPECT_EQ(Fnv1a<uint64_t>(""), 0xcbf29ce484222325U);
  EXPECT_EQ(Fnv1a<uint64_t>("foobar"), 0x85944171f73967e8U);
}

// The expected values come from a second implementation in Python. If they changed, runs would not
// be reproducible across versions.
TEST(HashSeed, HasFixedValues) {
  EXPECT_EQ(HashSeed(0, 0, ""), 0x7dc2c42b173ebf65u);
  EXPECT_EQ(HashSeed(1, 42, "pose"), 0x02942679a343dcfdu);
  EXPECT_EQ(HashSeed(1, 43, "pose"), 0xd61076a6fa8d2abbu);
  EXPECT_EQ(HashSeed(~0ull, ~0u, "loop"), 0x9069c24382fefbb3u);
}

TEST(HashSeed, DependsOnEachPart) {
  std::set<uint64_t> seeds;
  for (uint64_t run = 0; run < 10; ++run) {
    for (uint32_t frame = 0; frame < 100; ++frame) {
      for (const char* purpose : {"pose", "loop", ""}) {
        seeds.insert(HashSeed(run, frame, purpose));
      }
    }
  }
  EXPECT_EQ(seeds.size(), 3000u);
}

// Neighbouring frames must not get similar seeds: about half of the bits must differ.
TEST(HashSeed, ScattersNeighbours) {
  size_t changed = 0;
  for (uint32_t frame = 0; frame < 1000; ++frame) {
    changed += std::bitset<64>(HashSeed(1, frame, "x") ^ HashSeed(1, frame + 1, "x")).count();
  }
  EXPECT_NEAR(static_cast<double>(changed) / 1000.0, 32.0, 1.0);
}

}  // namespace

}  // namespace hullslam
