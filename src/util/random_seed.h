// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string_view>

#include "util/fnv1a.h"

namespace hullslam {

// The finaliser of SplitMix64 (Steele 2014).
constexpr uint64_t MixBits(uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

// A seed for the random choices of one frame and purpose. The same run seed, frame and purpose give
// the same seed on every platform, and no choice depends on the number of earlier draws.
constexpr uint64_t HashSeed(uint64_t run_seed, uint32_t frame, std::string_view purpose) {
  return MixBits(MixBits(MixBits(run_seed) ^ frame) ^ Fnv1a<uint64_t>(purpose));
}

}  // namespace hullslam
