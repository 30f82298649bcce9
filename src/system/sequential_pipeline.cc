// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/sequential_pipeline.h"

#include <exception>
#include <utility>

#include "hullslam/util/check.h"
#include "loop/loop_closer.h"
#include "loop/whole_map_adjustment.h"
#include "mapping/mapper.h"
#include "tracking/tracker.h"

namespace hullslam {
namespace {

class SequentialPipeline final : public Pipeline {
 public:
  SequentialPipeline(const Sensor& sensor, const SystemOptions& options)
      : sensor_(sensor),
        options_(options),
        tracker_(sensor, options.tracking, options.objects, options.seed),
        mapper_(
            sensor, options.mapping, options.objects,
            [this](std::shared_ptr<const Map> map) { map_ = std::move(map); }, options.vocabulary),
        loop_closer_(sensor, options.loop, options.objects, options.seed) {}

  void Begin(PipelineStart start) override {
    if (start.localization_only) {
      tracker_.LocaliseOnly();
    }
    EditMap([&] { mapper_.Begin(std::move(start.map), std::move(start.session)); });
  }

  FrameReport Track(std::shared_ptr<const Frame> frame) override {
    Check(!is_finished_, "Track after Finish");
    RethrowFailure();
    Tracker::Result result = tracker_.Process(std::move(frame), map_, MapperStatus());
    if (result.message) {
      EditMap([&] {
        mapper_.Process(*result.message, nullptr);
        CloseLoop();
      });
    }
    return std::move(result.report);
  }

  void Finish(const Cancellation* cancellation, const ProgressCallback& on_progress) override {
    RethrowFailure();
    if (!std::exchange(is_finished_, true)) {
      EditMap([&] { mapper_.Finish(cancellation, on_progress); });
    }
  }

  std::vector<TrackedFrame> TakeEarlyFrames() override {
    const std::shared_ptr<const Map> newest = map();
    return newest != nullptr ? tracker_.LocaliseEarlyFrames(*newest) : std::vector<TrackedFrame>();
  }

  std::shared_ptr<const Map> map() const override { return map_; }

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

 private:
  // Looks for a loop at the newest keyframe. After it has been closed, the whole map is adjusted.
  void CloseLoop() {
    const std::optional<KeyframeId> keyframe = mapper_.NewestKeyframe();
    if (!options_.loop.enabled || options_.vocabulary == nullptr || !keyframe) {
      return;
    }
    std::optional<MapCorrection> loop;
    {
      const ScopedTimer timer(loop_times_, "loop_detection");
      loop = loop_closer_.Process({mapper_.Snapshot(), *keyframe});
    }
    if (loop) {
      mapper_.Process(*loop, nullptr);
      AdjustMap();
    }
  }

  void AdjustMap() {
    if (!options_.loop.global_adjustment) {
      return;
    }
    std::optional<MapCorrection> adjustment;
    {
      const ScopedTimer timer(loop_times_, "loop_adjustment");
      adjustment = AdjustWholeMap(*map_, sensor_, options_.objects, nullptr);
    }
    if (adjustment) {
      mapper_.Process(*adjustment, nullptr);
    }
  }

  // Calls `edit`, which changes the live map, and stores its exception.
  template <typename Edit>
  void EditMap(const Edit& edit) {
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
  std::shared_ptr<const Map> map_;
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
