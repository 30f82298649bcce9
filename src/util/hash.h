// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <concepts>
#include <cstdint>
#include <string_view>

namespace hullslam {

// The hash FNV-1a (Fowler, Noll, Vo) of the bytes of a text, with as many bits as the type has: 32
// or 64. It is the same on every platform.
template <std::unsigned_integral T>
constexpr T Fnv1a(std::string_view text) {
  static_assert(sizeof(T) == 4 || sizeof(T) == 8);
  T hash = sizeof(T) == 4 ? T{2166136261U} : static_cast<T>(0xcbf29ce484222325U);
  for (const char byte : text) {
    hash = (hash ^ static_cast<unsigned char>(byte)) *
           (sizeof(T) == 4 ? T{16777619U} : static_cast<T>(0x100000001b3U));
  }
  return hash;
}

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
