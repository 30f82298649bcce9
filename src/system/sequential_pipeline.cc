// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/sequential_pipeline.h"

#include <exception>
#include <utility>

#include "hullslam/util/check.h"
#include "mapping/mapper.h"
#include "tracking/tracker.h"

namespace hullslam {
namespace {

class SequentialPipeline final : public Pipeline {
 public:
  SequentialPipeline(const Sensor& sensor, const SystemOptions& options)
      : tracker_(sensor, options.tracking, options.objects),
        mapper_(sensor, options.mapping, options.objects,
                [this](std::shared_ptr<const Map> map) { map_ = std::move(map); }) {}

  void Begin(PipelineStart start) override {
    tracker_.Begin(std::move(start.relocalise), start.localization_only);
    EditMap([&] { mapper_.Begin(std::move(start.map), std::move(start.session)); });
  }

  FrameReport Track(std::shared_ptr<const Frame> frame) override {
    Check(!is_finished_, "Track after Finish");
    RethrowFailure();
    Tracker::Result result = tracker_.Process(std::move(frame), map_, MapperStatus());
    if (result.message) {
      EditMap([&] { mapper_.Process(*result.message, nullptr); });
    }
    return std::move(result.report);
  }

  void Finish(const Cancellation* cancellation, const ProgressCallback& on_progress) override {
    RethrowFailure();
    if (!std::exchange(is_finished_, true)) {
      EditMap([&] { mapper_.Finish(cancellation, on_progress); });
    }
  }

  std::shared_ptr<const Map> map() const override { return map_; }

  bool is_mapping() const override { return false; }

  StageTimes times() const override {
    StageTimes times = tracker_.times();
    times.Merge(mapper_.times());
    return times;
  }

  std::map<ObjectRejection, size_t> object_rejections() const override {
    return mapper_.object_rejections();
  }

 private:
  // Calls `edit`, which changes the live map, and remembers its exception.
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

  std::shared_ptr<const Map> map_;
  Tracker tracker_;
  Mapper mapper_;
  std::exception_ptr failure_;
  bool is_finished_ = false;
};

}  // namespace

std::unique_ptr<Pipeline> MakeSequentialPipeline(const Sensor& sensor,
                                                 const SystemOptions& options) {
  return std::make_unique<SequentialPipeline>(sensor, options);
}

}  // namespace hullslam
