// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <span>
#include <vector>

#include "hullslam/frame/built_frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/messages.h"
#include "hullslam/system/options.h"
#include "hullslam/system/system.h"
#include "hullslam/util/cancellation.h"
#include "mapping/mapper.h"
#include "objects/validity.h"
#include "system/pipeline.h"
#include "tracking/remembered_frame.h"
#include "tracking/tracker.h"

// The end of a run. FinishMap and FinishRun have only the order of the steps; each step is
// explained where it is declared.

namespace hullslam {

// A step at the end of a run whose images were far apart, before FinishMap: makes keyframes of lost
// frames that are found in the map as it is now, and joins islands (FindJoin), until there are no
// more of either.
void GrowMap(Tracker& tracker, Mapper& mapper, const Sensor& sensor, const SystemOptions& options,
             const Cancellation* cancellation);

// Finishes the map once the last keyframes and loops are in it. A map of earlier sessions to which
// no keyframe was added is not changed. `cancellation` (may be null) and `on_progress` are for
// the adjustment of the whole map.
void FinishMap(Mapper& mapper, const Cancellation* cancellation = nullptr,
               const ProgressCallback& on_progress = {});

// Finishes the poses of the oldest remembered frames in the current map and forgets them, if more
// than kMostRemembered are remembered.
void FinishOldest(const Pipeline& pipeline, const Sensor& sensor, const SystemOptions& options,
                  std::list<RememberedFrame>& remembered, std::span<TrackedFrame> frames);

// Finishes the map, then the poses of the frames. `frames` are all frames of the run in order;
// `remembered` are those whose poses can be computed again. `on_map` and `on_poses` are told the
// progress of the two parts. Returns the islands that were not joined to the map.
std::vector<LeftIsland> FinishRun(Pipeline& pipeline, const Sensor& sensor,
                                  const SystemOptions& options,
                                  const std::list<RememberedFrame>& remembered,
                                  std::span<TrackedFrame> frames, const Cancellation* cancellation,
                                  const ProgressCallback& on_map, const ProgressCallback& on_poses);

// The counts of a run of `frames` frames, with the names of the reasons as in summary.json.
ObjectCounts CountObjects(const DetectionCounts& masks, size_t frames,
                          const std::map<ObjectRejection, size_t>& rejections);

}  // namespace hullslam
