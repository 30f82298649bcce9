// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string_view>

namespace hullslam {

// A seed for the random choices of one frame and purpose. The same run seed, frame and purpose give
// the same seed on every platform, and no choice depends on the number of earlier draws. The hash
// is FNV-1a over the purpose (Fowler, Noll, Vo), mixed by the finaliser of SplitMix64 (Steele
// 2014).
uint64_t HashSeed(uint64_t run_seed, uint32_t frame, std::string_view purpose);

}  // namespace hullslam
