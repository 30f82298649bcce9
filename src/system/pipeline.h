// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/objects/object_changes.h"
#include "hullslam/system/options.h"
#include "hullslam/util/cancellation.h"
#include "hullslam/util/stage_timer.h"
#include "objects/validity.h"

namespace hullslam {

// The initial state of a pipeline.
struct PipelineStart {
  Map map = {};          // of earlier sessions; a new map if it has no keyframes
  Session session = {};  // the session of the keyframes of this run
  // There are no keyframe requests, so nothing in the map is changed.
  bool localization_only = false;
  std::optional<Rigid3> world_from_cam = {};  // of the first image of a new map
};

// Runs the stages: frames in, poses out. Made by MakeSequentialPipeline and MakeThreadedPipeline.
class Pipeline {
 public:
  virtual ~Pipeline() = default;

  // To be called at most once, before the first Track. Without this call the map is new and its
  // keyframes belong to no session.
  virtual void Begin(PipelineStart start) = 0;
  // See System::SetLocalizationOnly. To be called by the thread of Track.
  virtual void SetLocalizationOnly(bool is_on) = 0;
  // See System::AwaitMasks. To be called by the thread of Track.
  virtual void AwaitMasks(bool is_on) = 0;
  // Sends late detections or an edit of an object to the mapper. To be called by the thread of
  // Track. Throws like Track.
  virtual void Edit(MapMessage message) = 0;
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

// Does everything inside Track. The same frames and options give the same bits. `sensor` must
// outlive the pipeline.
std::unique_ptr<Pipeline> MakeSequentialPipeline(const Sensor& sensor,
                                                 const SystemOptions& options);

// The behaviour of Track with a keyframe while the mapper is still busy with an earlier one.
enum class Pace {
  kWaitForMapper,  // waits, so that no keyframe is dropped
  kNeverWait,      // drops the keyframe, or if it is urgent, hurries the mapper, as in ORB-SLAM2
};

// Mapping runs in a thread of its own, so Track returns as soon as the frame has its pose. Results
// depend on timing. `sensor` must outlive the pipeline.
std::unique_ptr<Pipeline> MakeThreadedPipeline(const Sensor& sensor, const SystemOptions& options,
                                               Pace pace);

}  // namespace hullslam
