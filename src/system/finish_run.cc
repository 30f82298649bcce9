// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/finish_run.h"

#include <memory>

#include "objects/object_index.h"
#include "system/compose_trajectory.h"

namespace hullslam {

void FinishMap(Mapper& mapper, const Cancellation* cancellation,
               const ProgressCallback& on_progress) {
  if (!mapper.HasChangedMap()) {
    return;
  }
  mapper.KeepMainIsland();
  mapper.AdjustMap(cancellation, on_progress);
  mapper.FollowKnownSizesAtEnd();
  mapper.FinishObjects();
}

void FinishRun(Pipeline& pipeline, const Sensor& sensor, const SystemOptions& options,
               std::span<const RememberedFrame> remembered, std::span<TrackedFrame> frames,
               const Cancellation* cancellation, const ProgressCallback& on_map,
               const ProgressCallback& on_poses) {
  pipeline.Finish(cancellation, on_map);  // the last keyframes and loops, then FinishMap
  const std::shared_ptr<const Map> map = pipeline.map();
  if (map == nullptr) {
    return;
  }
  LoseFramesElsewhere(*map, frames);
  const ObjectIndex object_index(*map, sensor.camera);
  RefinePoses(*map, {sensor, options.tracking, options.objects, object_index, options.seed},
              remembered, frames, cancellation, on_poses);
  ReplaceEarlyFrames(pipeline.TakeEarlyFrames(cancellation, on_poses), frames);
}

}  // namespace hullslam
