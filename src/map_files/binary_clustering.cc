// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_files/binary_clustering.h"

#include <algorithm>
#include <array>
#include <limits>
#include <random>

#include "util/function_clones.h"

namespace hullslam {
namespace {

constexpr size_t kBits = 256;
constexpr size_t kChunk = 4096;      // descriptors per task
constexpr int kMostIterations = 30;  // a large set changes little in the last iterations

// For each bit, the number of descriptors of a cluster in which it is 1.
struct BitCounts {
  std::array<uint32_t, kBits> ones{};
  uint32_t members = 0;
};

HULLSLAM_FUNCTION_CLONES
void AddBits(const Descriptor& descriptor, uint32_t* ones) {
  for (size_t word = 0; word < descriptor.size(); ++word) {
    for (size_t bit = 0; bit < 64; ++bit) {
      ones[64 * word + bit] += static_cast<uint32_t>(descriptor[word] >> bit & 1);
    }
  }
}

// Replaces each distance by the distance to `centre` if that is smaller. Returns the sum of the
// distances.
HULLSLAM_FUNCTION_CLONES
uint64_t LowerDistances(std::span<const Descriptor> descriptors, const Descriptor& centre,
                        int* distances) {
  uint64_t sum = 0;
  for (size_t i = 0; i < descriptors.size(); ++i) {
    distances[i] = std::min(distances[i], HammingDistance(descriptors[i], centre));
    sum += static_cast<uint64_t>(distances[i]);
  }
  return sum;
}

HULLSLAM_FUNCTION_CLONES
void FindNearest(std::span<const Descriptor> descriptors, std::span<const Descriptor> centres,
                 uint32_t* nearest) {
  for (size_t i = 0; i < descriptors.size(); ++i) {
    int least = std::numeric_limits<int>::max();
    for (uint32_t c = 0; c < centres.size(); ++c) {
      const int distance = HammingDistance(descriptors[i], centres[c]);
      if (distance < least) {
        least = distance;
        nearest[i] = c;
      }
    }
  }
}

// Each further centre is a descriptor, drawn with a probability proportional to its distance from
// the nearest earlier centre.
std::vector<Descriptor> DrawCentres(std::span<const Descriptor> descriptors, size_t most,
                                    uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<int> distances(descriptors.size(), std::numeric_limits<int>::max());
  std::vector<Descriptor> centres = {descriptors[random() % descriptors.size()]};
  while (centres.size() < most) {
    const uint64_t sum = LowerDistances(descriptors, centres.back(), distances.data());
    if (sum == 0) {
      break;  // every descriptor is a centre
    }
    uint64_t left = random() % sum;
    size_t drawn = 0;
    for (; left >= static_cast<uint64_t>(distances[drawn]); ++drawn) {
      left -= static_cast<uint64_t>(distances[drawn]);
    }
    centres.push_back(descriptors[drawn]);
  }
  return centres;
}

// Assigns every descriptor to its nearest centre and counts the bits of the clusters.
std::vector<BitCounts> Assign(std::span<const Descriptor> descriptors,
                              std::span<const Descriptor> centres, TaskRunner& runner,
                              std::vector<uint32_t>& nearest) {
  const size_t chunks = (descriptors.size() + kChunk - 1) / kChunk;
  std::vector<std::vector<BitCounts>> counts(chunks);
  runner.Run(chunks, [&](size_t chunk) {
    const size_t begin = chunk * kChunk;
    const auto part = descriptors.subspan(begin, std::min(kChunk, descriptors.size() - begin));
    FindNearest(part, centres, nearest.data() + begin);
    counts[chunk].resize(centres.size());
    for (size_t i = 0; i < part.size(); ++i) {
      BitCounts& count = counts[chunk][nearest[begin + i]];
      AddBits(part[i], count.ones.data());
      ++count.members;
    }
  });
  for (size_t chunk = 1; chunk < chunks; ++chunk) {
    for (size_t c = 0; c < centres.size(); ++c) {
      counts[0][c].members += counts[chunk][c].members;
      for (size_t bit = 0; bit < kBits; ++bit) {
        counts[0][c].ones[bit] += counts[chunk][c].ones[bit];
      }
    }
  }
  return std::move(counts[0]);
}

Descriptor Majority(const BitCounts& counts) {
  Descriptor centre{};
  for (size_t bit = 0; bit < kBits; ++bit) {
    const bool is_one = 2 * uint64_t{counts.ones[bit]} > counts.members;
    centre[bit / 64] |= static_cast<uint64_t>(is_one) << (bit % 64);
  }
  return centre;
}

// Moves the centres to the majorities of their clusters. A centre without descriptors does not
// move.
bool MoveCentres(const std::vector<BitCounts>& counts, std::vector<Descriptor>& centres) {
  bool has_moved = false;
  for (size_t c = 0; c < centres.size(); ++c) {
    const Descriptor majority = counts[c].members > 0 ? Majority(counts[c]) : centres[c];
    has_moved = has_moved || majority != centres[c];
    centres[c] = majority;
  }
  return has_moved;
}

}  // namespace

std::vector<BinaryCluster> ClusterBinary(std::span<const Descriptor> descriptors, int most_clusters,
                                         uint64_t seed, TaskRunner& runner,
                                         const Cancellation* cancellation) {
  if (descriptors.empty()) {
    return {};
  }
  std::vector<Descriptor> centres =
      DrawCentres(descriptors, static_cast<size_t>(most_clusters), seed);
  std::vector<uint32_t> nearest(descriptors.size());
  std::vector<BitCounts> counts = Assign(descriptors, centres, runner, nearest);
  for (int i = 0; i < kMostIterations && MoveCentres(counts, centres); ++i) {
    counts = Assign(descriptors, centres, runner, nearest);
    if (IsRequested(cancellation)) {
      break;
    }
  }
  std::vector<BinaryCluster> clusters(centres.size());
  for (uint32_t i = 0; i < descriptors.size(); ++i) {
    clusters[nearest[i]].members.push_back(i);
  }
  for (size_t c = 0; c < centres.size(); ++c) {
    clusters[c].centre = centres[c];
  }
  std::erase_if(clusters, [](const BinaryCluster& cluster) { return cluster.members.empty(); });
  return clusters;
}

}  // namespace hullslam
