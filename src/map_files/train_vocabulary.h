// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hullslam/bow/vocabulary.h"
#include "hullslam/features/feature_set.h"
#include "hullslam/util/cancellation.h"
#include "util/task_runner.h"

namespace hullslam {

struct VocabularyTraining {
  int branching = 10;  // 2 to Vocabulary::kMostBranching
  int levels = 5;      // 1 to Vocabulary::kMostLevels
  uint64_t seed = 0;   // seed of the first cluster centres
};

// Trains a vocabulary on the descriptors of images (Nister and Stewenius 2006; Galvez-Lopez and
// Tardos 2012): the descriptors are divided into `branching` clusters, each cluster is divided
// again, and so on for `levels` levels. The words are the clusters of the last level and all
// clusters that cannot be divided further because their descriptors are equal. Returns nothing if
// `cancellation` (may be null) was requested. `on_progress` is called in this thread after each
// level. The result does not depend on how `runner` runs the tasks. Throws CheckError if there are
// no descriptors or an option is out of its range.
std::optional<Vocabulary> TrainVocabulary(std::span<const std::vector<Descriptor>> images,
                                          const VocabularyTraining& options, TaskRunner& runner,
                                          const Cancellation* cancellation = nullptr,
                                          const ProgressCallback& on_progress = {});

}  // namespace hullslam
