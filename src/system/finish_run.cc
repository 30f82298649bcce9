// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/finish_run.h"

#include <memory>

#include "map/islands.h"
#include "objects/object_index.h"
#include "system/compose_trajectory.h"

namespace hullslam {
namespace {

// Loses the frames that are not in the map, and computes the poses of the others again.
void FinishFrames(const Map& map, const Sensor& sensor, const SystemOptions& options,
                  const std::list<RememberedFrame>& remembered, std::span<TrackedFrame> frames,
                  const Cancellation* cancellation, const ProgressCallback& on_progress) {
  LoseFramesElsewhere(map, frames);
  const ObjectIndex object_index(map, sensor.camera);
  RefinePoses(map, {sensor, options.tracking, options.objects, object_index, options.seed},
              remembered, frames, cancellation, on_progress);
}

}  // namespace

void FinishMap(Mapper& mapper, const Cancellation* cancellation,
               const ProgressCallback& on_progress) {
  if (!mapper.HasChangedMap()) {
    return;
  }
  mapper.SplitIslands(cancellation);
  mapper.AdjustMap(cancellation, on_progress);
  mapper.FollowKnownSizesAtEnd();
  mapper.FinishObjects();
}

void FinishOldest(const Pipeline& pipeline, const Sensor& sensor, const SystemOptions& options,
                  std::list<RememberedFrame>& remembered, std::span<TrackedFrame> frames) {
  if (remembered.size() <= kMostRemembered) {
    return;
  }
  const std::shared_ptr<const Map> map = pipeline.map();
  if (map == nullptr) {  // a monocular camera that has not moved yet has no poses
    remembered.pop_front();
    return;
  }
  const ObjectIndex unused;  // the objects in a frame were found when it was tracked
  RefineOldest(*map, {sensor, options.tracking, options.objects, unused, options.seed},
               kMostRemembered, remembered, frames);
}

std::vector<LeftIsland> FinishRun(Pipeline& pipeline, const Sensor& sensor,
                                  const SystemOptions& options,
                                  const std::list<RememberedFrame>& remembered,
                                  std::span<TrackedFrame> frames, const Cancellation* cancellation,
                                  const ProgressCallback& on_map,
                                  const ProgressCallback& on_poses) {
  pipeline.Finish(cancellation, on_map);  // the last keyframes and loops, then FinishMap
  const std::shared_ptr<const Map> map = pipeline.map();
  if (map == nullptr) {
    return {};
  }
  std::vector<LeftIsland> left;
  for (const std::shared_ptr<const Map>& island : pipeline.left_islands()) {
    std::vector<TrackedFrame> of_island(frames.begin(), frames.end());
    FinishFrames(*island, sensor, options, remembered, of_island, cancellation, {});
    left.push_back({MainIsland(*island), island, ComposeTrajectory(*island, of_island)});
  }
  FinishFrames(*map, sensor, options, remembered, frames, cancellation, on_poses);
  ReplaceEarlyFrames(pipeline.TakeEarlyFrames(cancellation, on_poses), frames);
  return left;
}

}  // namespace hullslam
