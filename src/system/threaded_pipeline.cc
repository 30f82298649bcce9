// SPDX-License-Identifier: GPL-3.0-or-later
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <variant>

#include "hullslam/util/cancellation.h"
#include "hullslam/util/check.h"
#include "mapping/mapper.h"
#include "system/finish_run.h"
#include "system/loop_stages.h"
#include "system/pipeline.h"
#include "tracking/tracker.h"
#include "util/between_threads.h"
#include "util/task_runner.h"

namespace hullslam {
namespace {

constexpr size_t kMailboxCapacity = 8;  // larger than the number of requests that may wait

// Whether the mapper shortens its work because this message waits. Tracking may need a keyframe or
// a correction at once. Edits and late detections can wait, and there may be some for every frame:
// if the mapper hurried for them, it would hardly ever adjust the map.
bool IsUrgent(const MapMessage& message) {
  return !std::holds_alternative<LateDetections>(message) &&
         !std::holds_alternative<ObjectEdit>(message);
}

// In a monocular run the mapper is always busy, and tracking would have to share its core with the
// mapper all the time. With this niceness the mapper still gets a fifth of a core that another
// thread needs too.
constexpr int kMonocularMapperNiceness = 6;

class ThreadedPipeline final : public Pipeline {
 public:
  ThreadedPipeline(const Sensor& sensor, const SystemOptions& options, Pace pace)
      : sensor_(sensor),
        options_(options),
        is_monocular_(sensor.IsMonocular()),
        pace_(pace),
        tracker_(sensor, options.tracking, options.objects, options.seed),
        mapper_(
            sensor, options.mapping, options.objects,
            [this](std::shared_ptr<const Map> map) { Publish(std::move(map)); },
            options.vocabulary),
        messages_(kMailboxCapacity),
        loops_(sensor, options, [this](MapCorrection correction) { Post(std::move(correction)); }),
        mapping_thread_([this] { RunMapping(); }) {}

  ~ThreadedPipeline() override { Stop(); }

  // Meanwhile the mapper's thread waits for its first message.
  void Begin(PipelineStart start) override {
    tracker_.LocaliseOnly(start.localization_only);
    tracker_.BeginAt(start.world_from_cam);
    mapper_.Begin(std::move(start.map), std::move(start.session));
  }

  void SetLocalizationOnly(bool is_on) override { tracker_.LocaliseOnly(is_on); }

  void AwaitMasks(bool is_on) override { mapper_.AwaitMasks(is_on); }

  void KeepIdsSince(uint32_t revision) override { tracker_.KeepIdsSince(revision); }

  // The mailbox keeps the order, so a frame is a keyframe by then if it becomes one.
  void Edit(MapMessage message) override {
    Check(mapping_thread_.joinable(), "the map is edited after Finish");
    RethrowFailure();
    Post(std::move(message));
  }

  FrameReport Track(std::shared_ptr<const Frame> frame) override {
    Check(mapping_thread_.joinable(), "Track after Finish");
    RethrowFailure();
    const MapperStatus status = pace_ == Pace::kWaitForMapper ? MapperStatus() : Status();
    Tracker::Result result = tracker_.Process(std::move(frame), map_.Get(), status);
    mapper_.ExpectWideSteps(tracker_.HasWideSteps());
    if (result.message) {
      const bool is_initial = std::holds_alternative<InitialMap>(*result.message);
      if (is_initial || pace_ == Pace::kWaitForMapper) {
        PostAndWait(std::move(*result.message));
        if (is_initial) {
          WaitForMapper();  // the published map may also come from a loop correction
        }
      } else {
        Post(std::move(*result.message));
      }
    }
    return std::move(result.report);
  }

  void Finish(const Cancellation* cancellation, const ProgressCallback& on_progress) override {
    const bool is_first = mapping_thread_.joinable();
    if (is_first) {
      CloseLastLoops(cancellation);
    }
    Stop();
    RethrowFailure();
    if (is_first) {  // the mapper's thread has ended
      EditMap([&] {
        GrowMap(tracker_, mapper_, sensor_, options_, cancellation);
        FinishMap(mapper_, cancellation, on_progress);
      });
      RethrowFailure();
    }
  }

  std::vector<TrackedFrame> TakeEarlyFrames(const Cancellation* cancellation,
                                            const ProgressCallback& on_progress) override {
    const std::shared_ptr<const Map> newest = map();
    return newest != nullptr ? tracker_.LocaliseEarlyFrames(*newest, cancellation, on_progress)
                             : std::vector<TrackedFrame>();
  }

  std::shared_ptr<const Map> map() const override { return map_.Get(); }

  int busy_threads() const override { return (IsMapping() ? 1 : 0) + loops_.busy_threads(); }

  StageTimes times() const override {
    StageTimes times = tracker_.times();
    const std::lock_guard lock(mutex_);
    times.Merge(mapper_times_);
    times.Merge(loops_.times());
    return times;
  }

  std::map<ObjectRejection, size_t> object_rejections() const override {
    const std::lock_guard lock(mutex_);
    return object_rejections_;
  }

  const std::vector<ChangedObject>& object_changes() const override {
    return mapper_.object_changes();  // only Finish writes it
  }

  size_t contradicted_landmarks() const override { return mapper_.contradicted_landmarks(); }

  const std::vector<std::shared_ptr<const Map>>& left_islands() const override {
    return mapper_.left_islands();  // only Finish writes it
  }

 private:
  bool IsMapping() const {
    const std::lock_guard lock(mutex_);
    return is_busy_ || waiting_ > 0;
  }

  void WaitForMapper() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return (!is_busy_ && waiting_ == 0) || failure_; });
  }

  // Waits until loops at the last keyframes are in the map. If there is a final adjustment, the
  // adjustment of the whole map after such a loop is cancelled.
  void CloseLastLoops(const Cancellation* cancellation) {
    const bool is_cancelled = IsRequested(cancellation);
    const bool is_adjusted_later = options_.mapping.final_bundle_adjustment || is_cancelled;
    WaitForMapper();
    while (loops_.Settle(is_adjusted_later)) {
      WaitForMapper();
    }
  }

  MapperStatus Status() {
    const std::lock_guard lock(mutex_);
    return {.is_idle = !is_busy_ && waiting_ == 0, .requests_waiting = urgent_waiting_};
  }

  void Post(MapMessage message) {
    {
      const std::lock_guard lock(mutex_);
      ++waiting_;
      urgent_waiting_ += IsUrgent(message) ? 1 : 0;
      UpdateHurry();
    }
    messages_.Send(std::move(message));
  }

  // Waits until the mapper is done with all earlier messages, posts this one, and returns when its
  // keyframe is in the map.
  void PostAndWait(MapMessage message) {
    WaitForMapper();
    std::unique_lock lock(mutex_);
    const int before = published_;
    lock.unlock();
    Post(std::move(message));
    lock.lock();
    changed_.wait(lock, [&] { return published_ != before || failure_; });
  }

  void Publish(std::shared_ptr<const Map> map) {
    map_.Publish(std::move(map));
    const std::lock_guard lock(mutex_);
    ++published_;
    changed_.notify_all();
  }

  void RunMapping() {
    if (is_monocular_) {
      RunInBackground(kMonocularMapperNiceness);
    }
    while (const std::optional<MapMessage> message = messages_.Receive()) {
      BeginWork(*message);
      const bool is_done = EditMap([&] {
        const bool is_applied = mapper_.Process(*message, &hurry_);
        StartNextStage(*message, is_applied, options_, mapper_, map_.Get(), loops_);
      });
      if (!is_done) {
        messages_.Close();
        return;
      }
      EndWork();
    }
  }

  // Calls `edit`, which changes the live map, and copies the results of the mapper that other
  // threads may read. Returns false if there was an exception; also the copies may lack memory.
  template <typename Function>
  bool EditMap(const Function& edit) {
    std::exception_ptr failure;
    try {
      edit();
      StageTimes times = mapper_.times();
      std::map<ObjectRejection, size_t> rejections = mapper_.object_rejections();
      const std::lock_guard lock(mutex_);
      mapper_times_ = std::move(times);
      object_rejections_ = std::move(rejections);
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    failure_ = failure;
    changed_.notify_all();
    return failure == nullptr;
  }

  void BeginWork(const MapMessage& message) {
    const std::lock_guard lock(mutex_);
    is_busy_ = true;
    --waiting_;
    urgent_waiting_ -= IsUrgent(message) ? 1 : 0;
    UpdateHurry();
    changed_.notify_all();
  }

  void EndWork() {
    const std::lock_guard lock(mutex_);
    is_busy_ = false;
    UpdateHurry();
    changed_.notify_all();
  }

  // The mapper hurries with its message as long as an urgent one waits.
  void UpdateHurry() {
    if (is_busy_ && urgent_waiting_ > 0) {
      hurry_.Request();
    } else {
      hurry_.Reset();
    }
  }

  void Stop() {
    messages_.Close();
    if (mapping_thread_.joinable()) {
      mapping_thread_.join();
    }
  }

  void RethrowFailure() {
    loops_.RethrowFailure();
    const std::lock_guard lock(mutex_);
    if (failure_) {
      std::rethrow_exception(failure_);
    }
  }

  const Sensor& sensor_;
  const SystemOptions options_;
  const bool is_monocular_;
  const Pace pace_;
  Published<Map> map_;
  Tracker tracker_;
  Mapper mapper_;
  Mailbox<MapMessage> messages_;
  Cancellation hurry_;

  mutable std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  bool is_busy_ = false;
  int waiting_ = 0;
  int urgent_waiting_ = 0;  // the waiting messages that are urgent
  int published_ = 0;
  std::exception_ptr failure_;  // the first exception of the mapper, which then stops
  StageTimes mapper_times_;
  std::map<ObjectRejection, size_t> object_rejections_;

  LoopThreads loops_;
  std::thread mapping_thread_;  // last member, because the thread uses the others
};

}  // namespace

std::unique_ptr<Pipeline> MakeThreadedPipeline(const Sensor& sensor, const SystemOptions& options,
                                               Pace pace) {
  return std::make_unique<ThreadedPipeline>(sensor, options, pace);
}

}  // namespace hullslam
