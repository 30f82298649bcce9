// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_files/binary_clustering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "support/made_vocabulary.h"
#include "util/task_runner.h"

namespace hullslam {
namespace {

// Makes `each` descriptors for each of `groups` random centres: the centre with `flips` flipped
// bits. The groups take turns in the list.
std::vector<Descriptor> MakeGroups(size_t groups, size_t each, int flips) {
  std::mt19937_64 random(3);
  std::vector<Descriptor> centres;
  for (size_t i = 0; i < groups; ++i) {
    centres.push_back(RandomDescriptor(random));
  }
  std::vector<Descriptor> descriptors;
  for (size_t i = 0; i < groups * each; ++i) {
    Descriptor descriptor = centres[i % groups];
    for (int flip = 0; flip < flips; ++flip) {
      const uint64_t bit = random() % 256;
      descriptor[bit / 64] ^= uint64_t{1} << (bit % 64);
    }
    descriptors.push_back(descriptor);
  }
  return descriptors;
}

std::vector<BinaryCluster> Cluster(const std::vector<Descriptor>& descriptors, int most,
                                   uint64_t seed = 0) {
  SerialRunner runner;
  return ClusterBinary(descriptors, most, seed, runner, nullptr);
}

TEST(ClusterBinary, FindsSeparateGroups) {
  const std::vector<Descriptor> descriptors = MakeGroups(3, 50, 20);
  const std::vector<BinaryCluster> clusters = Cluster(descriptors, 3);
  ASSERT_EQ(clusters.size(), 3u);
  for (const BinaryCluster& cluster : clusters) {
    ASSERT_EQ(cluster.members.size(), 50u);
    for (const uint32_t member : cluster.members) {
      EXPECT_EQ(member % 3, cluster.members[0] % 3);
    }
  }
}

TEST(ClusterBinary, EveryDescriptorBelongsToTheFirstNearestCentre) {
  const std::vector<Descriptor> descriptors = MakeGroups(30, 20, 40);
  const std::vector<BinaryCluster> clusters = Cluster(descriptors, 8);
  ASSERT_EQ(clusters.size(), 8u);
  size_t count = 0;
  for (size_t c = 0; c < clusters.size(); ++c) {
    EXPECT_TRUE(std::is_sorted(clusters[c].members.begin(), clusters[c].members.end()));
    count += clusters[c].members.size();
    for (const uint32_t member : clusters[c].members) {
      const int own = HammingDistance(descriptors[member], clusters[c].centre);
      for (size_t other = 0; other < clusters.size(); ++other) {
        const int distance = HammingDistance(descriptors[member], clusters[other].centre);
        EXPECT_TRUE(other < c ? own < distance : own <= distance);
      }
    }
  }
  EXPECT_EQ(count, descriptors.size());
}

// Of the first three descriptors, two have bit 0, one has bit 1, and all have bit 255.
TEST(ClusterBinary, TheCentreIsTheMajorityOfEachBit) {
  constexpr uint64_t kLast = uint64_t{1} << 63;
  const std::vector<Descriptor> descriptors = {
      {1, 0, 0, kLast}, {3, 0, 0, kLast}, {0, 0, 0, kLast}, {0, 0, 0, kLast}};
  const std::vector<Descriptor> three(descriptors.begin(), descriptors.begin() + 3);
  EXPECT_EQ(Cluster(three, 1)[0].centre, (Descriptor{1, 0, 0, kLast}));
  EXPECT_EQ(Cluster(descriptors, 1)[0].centre, (Descriptor{0, 0, 0, kLast}))
      << "bit 0 is set in half of them, which is no majority";
}

TEST(ClusterBinary, ThereAreNoMoreClustersThanDifferentDescriptors) {
  std::vector<Descriptor> descriptors(10, Descriptor{1, 2, 3, 4});
  EXPECT_EQ(Cluster(descriptors, 5).size(), 1u);
  descriptors[4] = Descriptor{1, 2, 3, 5};
  const std::vector<BinaryCluster> clusters = Cluster(descriptors, 5);
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_EQ(clusters[0].members.size() + clusters[1].members.size(), 10u);
  EXPECT_TRUE(Cluster({}, 5).empty());
}

TEST(ClusterBinary, DependsOnTheSeedButNotOnThreads) {
  const std::vector<Descriptor> descriptors = MakeGroups(200, 60, 60);
  const auto centres = [](const std::vector<BinaryCluster>& clusters) {
    std::vector<Descriptor> result;
    for (const BinaryCluster& cluster : clusters) {
      result.push_back(cluster.centre);
    }
    return result;
  };
  ParallelRunner parallel(3);
  EXPECT_EQ(centres(ClusterBinary(descriptors, 10, 0, parallel, nullptr)),
            centres(Cluster(descriptors, 10)));
  EXPECT_NE(centres(Cluster(descriptors, 10, 1)), centres(Cluster(descriptors, 10)));
}

}  // namespace
}  // namespace hullslam
