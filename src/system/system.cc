// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/system/system.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "frame/frame_builder.h"
#include "hullslam/frame/dynamic_mask.h"
#include "hullslam/system/compose_trajectory.h"
#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "system/pipeline.h"
#include "system/sequential_pipeline.h"
#include "system/threaded_pipeline.h"

namespace hullslam {
namespace {

const SystemOptions& Validated(const SystemOptions& options) {
  options.Validate();
  return options;
}

Sensor MakeSensor(const SystemOptions& options) {
  Sensor sensor;
  sensor.camera = options.camera;
  sensor.bounds = options.camera.UndistortedBounds();
  sensor.levels = ScaleLevels::Create(options.features.level_count, options.features.scale_factor);
  sensor.close_depth = options.depth.close_baselines * sensor.baseline();
  sensor.depth_error = options.depth.error;
  sensor.frames_per_second = options.frames_per_second;
  return sensor;
}

cv::Mat ToGrey(const cv::Mat& image, bool rgb_order) {
  cv::Mat grey;
  switch (image.type()) {
    case CV_8UC1:
      return image;
    case CV_8UC3:
      cv::cvtColor(image, grey, rgb_order ? cv::COLOR_RGB2GRAY : cv::COLOR_BGR2GRAY);
      return grey;
    case CV_8UC4:
      cv::cvtColor(image, grey, rgb_order ? cv::COLOR_RGBA2GRAY : cv::COLOR_BGRA2GRAY);
      return grey;
    default:
      throw InputError("the image must have 8 bits per channel and 1, 3 or 4 channels");
  }
}

std::unique_ptr<Pipeline> MakePipeline(PipelineKind kind, const Sensor& sensor,
                                       const SystemOptions& options) {
  switch (kind) {
    case PipelineKind::kThreaded:
      return MakeThreadedPipeline(sensor, options, Pace::kWaitForMapper);
    case PipelineKind::kRealtime:
      return MakeThreadedPipeline(sensor, options, Pace::kNeverWait);
    default:
      return MakeSequentialPipeline(sensor, options);
  }
}

std::unique_ptr<FrameBuilder> MakeFrameBuilder(const Sensor& sensor, const SystemOptions& options) {
  const ObjectOptions& objects = options.objects;
  return std::make_unique<FrameBuilder>(
      sensor, options.depth, options.features,
      objects.enabled ? std::optional(objects.detection) : std::nullopt,
      SplitNames(options.tracking.dynamic_classes));
}

}  // namespace

System::System(const SystemOptions& options, PipelineKind kind)
    : options_(Validated(options)),
      kind_(kind),
      sensor_(MakeSensor(options_)),
      frame_builder_(MakeFrameBuilder(sensor_, options_)),
      pipeline_(MakePipeline(kind, sensor_, options_)) {}

System::~System() = default;

TrackedFrame System::Track(double timestamp, const cv::Mat& image, const cv::Mat& depth,
                           std::vector<InstanceMask> masks) {
  return Track(ImageInput{timestamp, ToGrey(image, options_.rgb_order), depth, std::move(masks)});
}

TrackedFrame System::Track(const ImageInput& image) {
  Check(std::isfinite(image.timestamp), "the time stamp is not a number");
  Check(frames_.empty() || image.timestamp > frames_.back().timestamp, "time stamps must increase");
  ValidateMasks(image.masks, options_.camera.width, options_.camera.height);
  const FrameId id(static_cast<uint32_t>(frames_.size()));
  std::shared_ptr<const Frame> frame;
  {
    const ScopedTimer timer(times_, "frame");
    frame = frame_builder_->Build(image, id);
  }
  const FrameReport report = pipeline_->Track(std::move(frame));
  frames_.push_back(report.tracked);
  if (frame_callback_) {
    frame_callback_(report);
  }
  return frames_.back();
}

void System::Finish(const Cancellation* cancellation) { pipeline_->Finish(cancellation); }

void System::Reset() {
  auto frame_builder = MakeFrameBuilder(sensor_, options_);
  pipeline_ = MakePipeline(kind_, sensor_, options_);  // the old one ends its threads
  frame_builder_ = std::move(frame_builder);
  frames_.clear();
  times_ = {};
}

std::shared_ptr<const Map> System::map() const { return pipeline_->map(); }

Trajectory System::trajectory() const {
  const std::shared_ptr<const Map> map = pipeline_->map();
  return map != nullptr ? ComposeTrajectory(*map, frames_) : Trajectory();
}

StageTimes System::times() const {
  StageTimes times = times_;
  times.Merge(pipeline_->times());
  const auto& samples = times.samples();
  const auto frame = samples.find("frame");
  const auto pose = samples.find("pose");
  StageTimes all = times;
  if (frame != samples.end() && pose != samples.end()) {
    for (size_t i = 0; i < std::min(frame->second.size(), pose->second.size()); ++i) {
      all.Add("track", frame->second[i] + pose->second[i]);
    }
  }
  return all;
}

ObjectCounts System::object_counts() const {
  ObjectCounts counts;
  counts.detections = frame_builder_->counts().detections;
  counts.frames_with_masks = frame_builder_->counts().frames_with_masks;
  counts.frames_without_masks = frames_.size() - counts.frames_with_masks;
  for (const auto& [reason, count] : frame_builder_->counts().rejections) {
    counts.rejections["mask_" + ToString(reason)] = count;
  }
  for (const auto& [reason, count] : pipeline_->object_rejections()) {
    counts.rejections[ToString(reason)] = count;
  }
  return counts;
}

}  // namespace hullslam
