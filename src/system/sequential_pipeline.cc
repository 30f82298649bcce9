// SPDX-License-Identifier: GPL-3.0-or-later
#include <exception>
#include <utility>

#include "hullslam/util/check.h"
#include "loop/loop_closer.h"
#include "loop/loop_correction.h"
#include "mapping/mapper.h"
#include "system/finish_run.h"
#include "system/loop_stages.h"
#include "system/pipeline.h"
#include "tracking/tracker.h"
#include "util/between_threads.h"

namespace hullslam {
namespace {

class SequentialPipeline final : public Pipeline, private LoopStages {
 public:
  SequentialPipeline(const Sensor& sensor, const SystemOptions& options)
      : sensor_(sensor),
        options_(options),
        tracker_(sensor, options.tracking, options.objects, options.seed),
        mapper_(
            sensor, options.mapping, options.objects,
            [this](std::shared_ptr<const Map> map) { map_.Publish(std::move(map)); },
            options.vocabulary),
        loop_closer_(sensor, options.loop, options.objects, options.seed) {}

  void Begin(PipelineStart start) override {
    tracker_.LocaliseOnly(start.localization_only);
    tracker_.BeginAt(start.world_from_cam);
    EditMap([&] { mapper_.Begin(std::move(start.map), std::move(start.session)); });
  }

  void SetLocalizationOnly(bool is_on) override { tracker_.LocaliseOnly(is_on); }

  void AwaitMasks(bool is_on) override { mapper_.AwaitMasks(is_on); }

  void KeepIdsSince(uint32_t revision) override { tracker_.KeepIdsSince(revision); }

  void Edit(MapMessage message) override {
    Check(!is_finished_, "the map is edited after Finish");
    RethrowFailure();
    EditMap([&] { Process(message); });
  }

  FrameReport Track(std::shared_ptr<const Frame> frame) override {
    Check(!is_finished_, "Track after Finish");
    RethrowFailure();
    Tracker::Result result = tracker_.Process(std::move(frame), map_.Get(), MapperStatus());
    mapper_.ExpectWideSteps(tracker_.HasWideSteps());
    if (result.message) {
      EditMap([&] { Process(*result.message); });
    }
    return std::move(result.report);
  }

  void Finish(const Cancellation* cancellation, const ProgressCallback& on_progress) override {
    RethrowFailure();
    if (!std::exchange(is_finished_, true)) {
      EditMap([&] {
        GrowMap(tracker_, mapper_, sensor_, options_, cancellation);
        FinishMap(mapper_, cancellation, on_progress);
      });
    }
  }

  std::vector<TrackedFrame> TakeEarlyFrames(const Cancellation* cancellation,
                                            const ProgressCallback& on_progress) override {
    const std::shared_ptr<const Map> newest = map();
    return newest != nullptr ? tracker_.LocaliseEarlyFrames(*newest, cancellation, on_progress)
                             : std::vector<TrackedFrame>();
  }

  std::shared_ptr<const Map> map() const override { return map_.Get(); }

  int busy_threads() const override { return 0; }

  StageTimes times() const override {
    StageTimes times = tracker_.times();
    times.Merge(mapper_.times());
    times.Merge(loop_times_);
    return times;
  }

  std::map<ObjectRejection, size_t> object_rejections() const override {
    return mapper_.object_rejections();
  }

  const std::vector<ChangedObject>& object_changes() const override {
    return mapper_.object_changes();
  }

  size_t contradicted_landmarks() const override { return mapper_.contradicted_landmarks(); }

  const std::vector<std::shared_ptr<const Map>>& left_islands() const override {
    return mapper_.left_islands();
  }

 private:
  // Processes a message and runs the stages that follow it, whose corrections are messages too.
  void Process(const MapMessage& message) {
    const bool is_applied = mapper_.Process(message, nullptr);
    StartNextStage(message, is_applied, options_, mapper_, map_.Get(), *this);
  }

  void Seek(LoopQuery query) override {
    std::optional<MapCorrection> loop;
    {
      const ScopedTimer timer(loop_times_, "loop_detection");
      loop = loop_closer_.Process(std::move(query));
    }
    if (loop) {
      Process(std::move(*loop));
    }
  }

  void Adjust(std::shared_ptr<const Map> corrected) override {
    std::optional<MapCorrection> adjustment;
    {
      const ScopedTimer timer(loop_times_, "loop_adjustment");
      adjustment = AdjustWholeMap(*corrected, sensor_, options_.objects, nullptr);
    }
    if (adjustment) {
      Process(std::move(*adjustment));
    }
  }

  // Calls `edit`, which changes the live map, and stores its exception.
  template <typename Function>
  void EditMap(const Function& edit) {
    try {
      edit();
    } catch (...) {
      failure_ = std::current_exception();
      throw;
    }
  }

  void RethrowFailure() const {
    if (failure_) {
      std::rethrow_exception(failure_);
    }
  }

  const Sensor& sensor_;
  const SystemOptions options_;
  Published<Map> map_;
  Tracker tracker_;
  Mapper mapper_;
  LoopCloser loop_closer_;
  StageTimes loop_times_;
  std::exception_ptr failure_;
  bool is_finished_ = false;
};

}  // namespace

std::unique_ptr<Pipeline> MakeSequentialPipeline(const Sensor& sensor,
                                                 const SystemOptions& options) {
  return std::make_unique<SequentialPipeline>(sensor, options);
}

}  // namespace hullslam
