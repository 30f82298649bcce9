// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/finish_run.h"

#include <memory>
#include <optional>
#include <utility>

#include "frame/measure_point.h"
#include "loop/island_join.h"
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

bool AddLostKeyframes(Tracker& tracker, Mapper& mapper, const Cancellation* cancellation) {
  bool has_grown = false;
  while (!IsRequested(cancellation)) {
    std::optional<KeyframeRequest> request = tracker.FindLostKeyframe(mapper.Snapshot());
    if (!request) {
      break;
    }
    has_grown |= mapper.Process(std::move(*request), cancellation);
  }
  return has_grown;
}

bool JoinOnce(Mapper& mapper, const Sensor& sensor, const SystemOptions& options,
              const Cancellation* cancellation) {
  Map map = mapper.Snapshot();
  const IslandId main = MainIsland(map);
  for (const IslandId island : Islands(map)) {
    if (island == main) {
      continue;
    }
    for (const KeyframeId keyframe : KeyframesOf(map, island)) {
      if (IsRequested(cancellation)) {
        return false;
      }
      std::optional<MapCorrection> join = FindJoin(map, keyframe, WithWideErrors(sensor),
                                                   options.loop, options.objects, options.seed);
      if (join) {
        return mapper.Process(std::move(*join), cancellation);
      }
    }
  }
  return false;
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

void GrowMap(Tracker& tracker, Mapper& mapper, const Sensor& sensor, const SystemOptions& options,
             const Cancellation* cancellation) {
  if (!tracker.HasHadWideSteps()) {
    return;
  }
  mapper.ExpectWideSteps(true);
  do {
    AddLostKeyframes(tracker, mapper, cancellation);
  } while (JoinOnce(mapper, sensor, options, cancellation));
}

ObjectCounts CountObjects(const DetectionCounts& masks, size_t frames,
                          const std::map<ObjectRejection, size_t>& rejections) {
  ObjectCounts counts;
  counts.detections = masks.detections;
  counts.frames_with_masks = masks.frames_with_masks;
  counts.frames_without_masks = frames - masks.frames_with_masks;
  for (const auto& [reason, count] : masks.rejections) {
    counts.rejections["mask_" + ToString(reason)] = count;
  }
  for (const auto& [reason, count] : rejections) {
    counts.rejections[ToString(reason)] = count;
  }
  return counts;
}

}  // namespace hullslam
