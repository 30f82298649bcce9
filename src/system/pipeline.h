// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/objects/object_changes.h"
#include "hullslam/util/cancellation.h"
#include "hullslam/util/stage_timer.h"
#include "objects/validity.h"
#include "system/pipeline_start.h"

namespace hullslam {

// Runs the stages: frames in, poses out. Made by MakeSequentialPipeline and MakeThreadedPipeline.
class Pipeline {
 public:
  virtual ~Pipeline() = default;

  // To be called at most once, before the first Track. Without this call the map is new and its
  // keyframes belong to no session.
  virtual void Begin(PipelineStart start) = 0;
  // See System::SetLocalizationOnly. To be called by the thread of Track.
  virtual void SetLocalizationOnly(bool is_on) = 0;
  // See System::AwaitMasks and System::AddMasks. To be called by the thread of Track.
  virtual void AwaitMasks(bool is_on) = 0;
  virtual void AddDetections(LateDetections late) = 0;
  // See Tracker::KeepIdsSince. To be called by the thread of Track.
  virtual void KeepIdsSince(uint32_t revision) = 0;
  // Frames come in order of time. Throws what a stage throws, and CheckError after Finish. After
  // mapping has thrown an exception, its live map may be half edited. So mapping stops, all later
  // calls of Track and Finish throw the same exception, and map() stays the last published map.
  virtual FrameReport Track(std::shared_ptr<const Frame> frame) = 0;
  // Waits until all keyframes and the last loops are in the map. Then it finishes the map
  // (FinishMap, system/finish_run.h).
  virtual void Finish(const Cancellation* cancellation, const ProgressCallback& on_progress) = 0;
  void Finish() { Finish(nullptr, {}); }
  // See Tracker::LocaliseEarlyFrames. To be called after Finish; the second call gives nothing.
  virtual std::vector<TrackedFrame> TakeEarlyFrames(const Cancellation* cancellation,
                                                    const ProgressCallback& on_progress) = 0;
  std::vector<TrackedFrame> TakeEarlyFrames() { return TakeEarlyFrames(nullptr, {}); }
  // The newest snapshot; null before the first keyframe.
  virtual std::shared_ptr<const Map> map() const = 0;
  // The number of threads, besides the thread of Track, that currently work on the map. May be
  // called by any thread.
  virtual int busy_threads() const = 0;
  // Durations of the stages; complete after Finish. These two may be called at any time by the
  // thread that calls Track.
  virtual StageTimes times() const = 0;
  // The number of rejections of objects, by reason; complete after Finish.
  virtual std::map<ObjectRejection, size_t> object_rejections() const = 0;
  // See Mapper::object_changes. To be called after Finish.
  virtual const std::vector<ChangedObject>& object_changes() const = 0;
  // See Mapper::contradicted_landmarks. To be called after Finish.
  virtual size_t contradicted_landmarks() const = 0;
  // See Mapper::left_islands. To be called after Finish, which fills it in.
  virtual const std::vector<std::shared_ptr<const Map>>& left_islands() const = 0;
};

}  // namespace hullslam
