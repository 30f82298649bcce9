// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hullslam/geometry/trajectory.h"
#include "hullslam/settings/loaded_settings.h"
#include "hullslam/system/system.h"
#include "hullslam/util/mapped_vector.h"
#include "report/lost_frames.h"
#include "report/object_results.h"
#include "results/summary.h"

namespace hullslam {

// The events of a run that the system does not know.
struct RunResult {
  size_t given = 0;    // frames that were loaded or skipped before the run ended
  size_t skipped = 0;  // frames with an image that cannot be read
  double seconds = 0.0;
  bool was_interrupted = false;
  std::optional<std::string> input_failure = {};  // why a frame's input ended the run early
  InitialisationSummary initialisation = {};
  MappedVector<FrameNote> notes = {};  // one per frame of the system
  // The frames as they were tracked, for a recording of live poses; Finish computes some again.
  std::vector<TrackedFrame> live = {};
};

// The content of summary.json for a finished run, but for masks, objects and what belongs to its
// sequence. Errors are only known with ground truth, which may be absent; what is odd about them,
// or about motion priors, is added to `warnings`.
RunSummary SummarizeRun(const RunResult& result, const System& system,
                        const std::optional<Trajectory>& groundtruth,
                        std::vector<std::string>& warnings);
// Says why a run of `frames` frames failed: an input ended it, it was interrupted, or too many
// frames were lost (RunOptions). Empty if it did not fail.
std::string DescribeRunEnd(const RunResult& result, const System& system, size_t frames,
                           const RunSummary& summary);
// How many frames used motion priors, for people; empty if none did.
std::string DescribePriors(std::span<const TrackedFrame> frames);
// The settings of a run, and how it ended.
ProvenanceSummary SummarizeSettings(const LoadedSettings& settings, const RunResult& result);

// The numbers of changes by the names of ObjectChange, with a zero for each kind that did not
// happen.
std::map<std::string, size_t> CountChanges(const std::vector<ChangedObject>& changes);

ObjectsSummary SummarizeObjects(const ObjectResults& report, const ObjectCounts& counts);

}  // namespace hullslam
