// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace hullslam::synthetic {

// The `counter`-th random word of the stream `seed` (SplitMix64, Steele 2014). A word does not
// depend on earlier draws, so pixels can be drawn in any order and by any thread.
inline uint64_t CounterHash(uint64_t seed, uint64_t counter) {
  uint64_t x = seed + (counter + 1) * 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

// A uniform number in [0, 1) from the upper bits of a random word.
inline double UnitInterval(uint64_t word) { return static_cast<double>(word >> 11) * 0x1.0p-53; }

// A stream of random numbers that are drawn in order, the same on every platform (the distributions
// of the standard library differ between platforms).
class RandomStream {
 public:
  explicit RandomStream(uint64_t seed) : seed_(seed) {}

  uint64_t Word() { return CounterHash(seed_, counter_++); }
  double Uniform(double low, double high) { return low + (high - low) * UnitInterval(Word()); }
  // A uniform integer from 0 to count - 1.
  int Index(int count) {
    return static_cast<int>(UnitInterval(Word()) * static_cast<double>(count));
  }

 private:
  uint64_t seed_;
  uint64_t counter_ = 0;
};

// A table of quantiles of the standard normal distribution, at the midpoints of 4096 equal steps of
// probability. It converts 12 random bits to a normally distributed number (at most 3.7 sigma)
// faster than a formula with a logarithm.
class NormalTable {
 public:
  static constexpr int kBits = 12;

  NormalTable();
  // Uses the low 12 bits of `word`.
  float operator()(uint64_t word) const { return quantiles_[word & (quantiles_.size() - 1)]; }

 private:
  std::array<float, size_t{1} << kBits> quantiles_{};
};

}  // namespace hullslam::synthetic
