// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/loop_stages.h"

#include <optional>
#include <utility>
#include <variant>

#include "loop/loop_correction.h"

namespace hullslam {

void StartNextStage(const MapMessage& message, bool is_applied, const SystemOptions& options,
                    Mapper& mapper, const std::shared_ptr<const Map>& published,
                    LoopStages& stages) {
  const auto* const correction = std::get_if<MapCorrection>(&message);
  const bool is_adjustment = correction != nullptr && !correction->loop;
  const bool has_no_loop = is_adjustment || std::holds_alternative<LateDetections>(message) ||
                           std::holds_alternative<ObjectEdit>(message);
  if (!options.loop.enabled || options.vocabulary == nullptr || has_no_loop) {
    return;
  }
  if (correction != nullptr && is_applied) {
    if (options.loop.global_adjustment) {
      stages.Adjust(published);
    }
  } else if (const std::optional<KeyframeId> keyframe = mapper.NewestKeyframe()) {
    stages.Seek({mapper.Snapshot(), *keyframe});
  }
}

LoopThreads::LoopThreads(const Sensor& sensor, const SystemOptions& options,
                         std::function<void(MapCorrection)> send)
    : sensor_(sensor),
      options_(options),
      send_(std::move(send)),
      closer_(sensor, options.loop, options.objects, options.seed),
      seeker_([this](LoopQuery query) { SeekNow(std::move(query)); }),
      adjuster_([this](const Adjustment& adjustment) { AdjustNow(adjustment); }) {}

LoopThreads::~LoopThreads() { GiveUpAdjustment(); }

void LoopThreads::Seek(LoopQuery query) { seeker_.Post(std::move(query)); }

void LoopThreads::Adjust(std::shared_ptr<const Map> corrected) {
  const auto cancellation = std::make_shared<Cancellation>();
  {
    const std::lock_guard lock(mutex_);
    cancellation_ = cancellation;
  }
  adjuster_.Post({std::move(corrected), cancellation});
}

bool LoopThreads::Settle(bool give_up_adjustment) {
  seeker_.WaitUntilIdle();
  if (give_up_adjustment) {
    GiveUpAdjustment();
  }
  adjuster_.WaitUntilIdle();
  const std::lock_guard lock(mutex_);
  return std::exchange(has_sent_, false);
}

int LoopThreads::busy_threads() const {
  return (seeker_.IsBusy() ? 1 : 0) + (adjuster_.IsBusy() ? 1 : 0);
}

StageTimes LoopThreads::times() const {
  const std::lock_guard lock(mutex_);
  return times_;
}

void LoopThreads::RethrowFailure() const {
  seeker_.RethrowFailure();
  adjuster_.RethrowFailure();
}

void LoopThreads::SeekNow(LoopQuery query) {
  StageTimes times;
  std::optional<MapCorrection> correction;
  {
    const ScopedTimer timer(times, "loop_detection");
    correction = closer_.Process(std::move(query));
  }
  {
    const std::lock_guard lock(mutex_);
    times_.Merge(times);
  }
  if (correction) {
    GiveUpAdjustment();
    Send(std::move(*correction));
  }
}

void LoopThreads::AdjustNow(const Adjustment& adjustment) {
  StageTimes times;
  std::optional<MapCorrection> correction;
  {
    const ScopedTimer timer(times, "loop_adjustment");
    correction =
        AdjustWholeMap(*adjustment.map, sensor_, options_.objects, adjustment.cancellation.get());
  }
  {
    const std::lock_guard lock(mutex_);
    times_.Merge(times);
  }
  if (correction) {
    Send(std::move(*correction));
  }
}

void LoopThreads::Send(MapCorrection correction) {
  {
    const std::lock_guard lock(mutex_);
    has_sent_ = true;
  }
  send_(std::move(correction));
}

void LoopThreads::GiveUpAdjustment() {
  const std::lock_guard lock(mutex_);
  if (cancellation_) {
    cancellation_->Request();
  }
}

}  // namespace hullslam
