// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hullslam/features/feature_set.h"
#include "hullslam/util/cancellation.h"
#include "util/task_runner.h"

namespace hullslam {

struct BinaryCluster {
  Descriptor centre{};            // the majority of each bit; 0 if as many members have 1 as 0
  std::vector<uint32_t> members;  // increasing; at least one
};

// Divides descriptors into at most `most_clusters` clusters with small Hamming distances to their
// centres (k-medians). Every descriptor belongs to the nearest centre; ties go to the first. The
// initial centres are drawn as in k-means++ (Arthur and Vassilvitskii 2007), which uses squared
// Euclidean distances; for binary vectors these are the Hamming distances. There are fewer clusters
// if there are fewer different descriptors. Stops early if `cancellation` (may be null) is
// requested. The result depends on the arguments only, not on how `runner` runs the tasks.
std::vector<BinaryCluster> ClusterBinary(std::span<const Descriptor> descriptors, int most_clusters,
                                         uint64_t seed, TaskRunner& runner,
                                         const Cancellation* cancellation);

}  // namespace hullslam
