// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/messages.h"
#include "hullslam/system/options.h"
#include "hullslam/util/cancellation.h"
#include "mapping/mapper.h"
#include "system/pipeline.h"
#include "tracking/remembered_frame.h"

// The steps at the end of a run, in their order. finish_run.cc has only this order; each step is
// explained where it is declared.
namespace hullslam {

// Finishes the map once the last keyframes and loops are in it. A map of earlier sessions to which
// no keyframe was added is not changed. `cancellation` (may be null) and `on_progress` are those of
// the adjustment of the whole map.
void FinishMap(Mapper& mapper, const Cancellation* cancellation = nullptr,
               const ProgressCallback& on_progress = {});

// Finishes the map, then the poses of the frames. `frames` are all frames of the run in order;
// `remembered` are those whose poses can be computed again. `on_map` and `on_poses` are told the
// progress of the two parts.
void FinishRun(Pipeline& pipeline, const Sensor& sensor, const SystemOptions& options,
               std::span<const RememberedFrame> remembered, std::span<TrackedFrame> frames,
               const Cancellation* cancellation, const ProgressCallback& on_map,
               const ProgressCallback& on_poses);

}  // namespace hullslam
