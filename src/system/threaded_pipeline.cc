// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/threaded_pipeline.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <variant>

#include "hullslam/util/cancellation.h"
#include "hullslam/util/check.h"
#include "hullslam/util/mailbox.h"
#include "mapping/mapper.h"
#include "tracking/tracker.h"
#include "util/published.h"

namespace hullslam {
namespace {

constexpr size_t kMailboxCapacity = 8;  // more than the keyframe policy lets wait

class ThreadedPipeline final : public Pipeline {
 public:
  ThreadedPipeline(const Sensor& sensor, const SystemOptions& options, Pace pace)
      : pace_(pace),
        tracker_(sensor, options.tracking, options.objects),
        mapper_(sensor, options.mapping, options.objects,
                [this](std::shared_ptr<const Map> map) { Publish(std::move(map)); }),
        messages_(kMailboxCapacity),
        mapping_thread_([this] { RunMapping(); }) {}

  ~ThreadedPipeline() override { Stop(); }

  FrameReport Track(std::shared_ptr<const Frame> frame) override {
    Check(mapping_thread_.joinable(), "Track after Finish");
    RethrowFailure();
    const MapperStatus status = pace_ == Pace::kWaitForMapper ? MapperStatus() : Status();
    Tracker::Result result = tracker_.Process(std::move(frame), map_.Get(), status);
    if (result.message) {
      const bool is_initial = std::holds_alternative<InitialMap>(*result.message);
      if (is_initial || pace_ == Pace::kWaitForMapper) {
        PostAndWait(std::move(*result.message));
      } else {
        Post(std::move(*result.message));
      }
    }
    return std::move(result.report);
  }

  void Finish(const Cancellation* cancellation) override {
    const bool is_first = mapping_thread_.joinable();
    Stop();
    RethrowFailure();
    if (is_first) {
      mapper_.Finish(cancellation);  // its thread has ended
    }
  }

  std::shared_ptr<const Map> map() const override { return map_.Get(); }

  StageTimes times() const override {
    StageTimes times = tracker_.times();
    times.Merge(mapper_.times());
    return times;
  }

  std::map<ObjectRejection, size_t> object_rejections() const override {
    return mapper_.object_rejections();
  }

 private:
  MapperStatus Status() {
    const std::lock_guard lock(mutex_);
    return {.is_idle = !is_busy_ && waiting_ == 0, .requests_waiting = waiting_};
  }

  void Post(MapMessage message) {
    {
      const std::lock_guard lock(mutex_);
      ++waiting_;
      if (is_busy_) {
        hurry_.Request();
      }
    }
    messages_.Send(std::move(message));
  }

  // Waits until the mapper is done with all earlier messages, posts this one, and returns when its
  // keyframe is in the map.
  void PostAndWait(MapMessage message) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return (!is_busy_ && waiting_ == 0) || failure_; });
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
    while (const std::optional<MapMessage> message = messages_.Receive()) {
      SetBusy(true);
      try {
        mapper_.Process(*message, &hurry_);
      } catch (...) {
        const std::lock_guard lock(mutex_);
        failure_ = std::current_exception();
        changed_.notify_all();
      }
      SetBusy(false);
    }
  }

  void SetBusy(bool is_busy) {
    const std::lock_guard lock(mutex_);
    is_busy_ = is_busy;
    if (is_busy) {
      --waiting_;
    }
    if (waiting_ == 0) {
      hurry_.Reset();
    }
    changed_.notify_all();
  }

  void Stop() {
    messages_.Close();
    if (mapping_thread_.joinable()) {
      mapping_thread_.join();
    }
  }

  void RethrowFailure() {
    const std::lock_guard lock(mutex_);
    if (failure_) {
      std::rethrow_exception(std::exchange(failure_, nullptr));
    }
  }

  const Pace pace_;
  Published<Map> map_;
  Tracker tracker_;
  Mapper mapper_;
  Mailbox<MapMessage> messages_;
  Cancellation hurry_;

  std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  bool is_busy_ = false;
  int waiting_ = 0;
  int published_ = 0;
  std::exception_ptr failure_;

  std::thread mapping_thread_;  // last member, because the thread uses the others
};

}  // namespace

std::unique_ptr<Pipeline> MakeThreadedPipeline(const Sensor& sensor, const SystemOptions& options,
                                               Pace pace) {
  return std::make_unique<ThreadedPipeline>(sensor, options, pace);
}

}  // namespace hullslam
