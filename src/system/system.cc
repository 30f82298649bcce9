// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/system/system.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "frame/detection/mask_region.h"
#include "frame/frame_builder.h"
#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "objects/object_extents.h"
#include "system/compose_trajectory.h"
#include "system/finish_run.h"
#include "system/idle_core_runner.h"
#include "system/make_sensor.h"
#include "system/pipeline.h"
#include "tracking/remembered_frame.h"
#include "util/task_runner.h"
#include "util/text.h"

namespace hullslam {
namespace {

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
      SplitNames(options.tracking.dynamic_classes), options.vocabulary,
      options.tracking.remove_dynamic);
}

// Words of two vocabularies can be compared if their contents are equal. It does not matter whether
// they are one object or were read twice.
void RequireSameVocabulary(const Map& map, const Vocabulary* expected) {
  const Vocabulary* const found = map.vocabulary().get();
  if (map.keyframes().empty() || found == expected) {
    return;
  }
  if (found == nullptr) {
    throw InputError(
        "the map has no index of visual words, but SystemOptions::vocabulary is set; "
        "read the map with ReadMap(path, options)");
  }
  if (expected == nullptr || found->hash() != expected->hash()) {
    throw InputError(fmt::format(
        "the map has the vocabulary {:016x}, SystemOptions::vocabulary is {}; expected the same",
        found->hash(), expected != nullptr ? fmt::format("{:016x}", expected->hash()) : "not set"));
  }
}

// Adds whether the camera was lost or found with this frame. `former` are the frames before it. A
// new island is a new begin, and not a place that is found again.
void AddEventsOfCamera(std::span<const TrackedFrame> former, FrameReport& report) {
  const TrackingState before =
      former.empty() ? TrackingState::kNotInitialized : former.back().state;
  const TrackingState now = report.tracked.state;
  std::vector<MapEvent>& events = report.events;
  if (before == TrackingState::kTracked && now == TrackingState::kLost) {
    events.push_back({.kind = MapEventKind::kLost});
  } else if (before == TrackingState::kLost && now == TrackingState::kTracked &&
             std::ranges::find(events, MapEventKind::kIslandBegun, &MapEvent::kind) ==
                 events.end()) {
    events.push_back({.kind = MapEventKind::kRelocalised});
  }
}

// Sets a flag during its lifetime.
class ScopedFlag {
 public:
  explicit ScopedFlag(std::atomic<bool>& flag) : flag_(flag) { flag_ = true; }
  ~ScopedFlag() { flag_ = false; }
  ScopedFlag(const ScopedFlag&) = delete;
  ScopedFlag& operator=(const ScopedFlag&) = delete;

 private:
  std::atomic<bool>& flag_;
};

}  // namespace

System::System(const SystemOptions& options, PipelineKind kind, SystemStart start)
    : options_(options),
      kind_(kind),
      start_(std::move(start)),
      sensor_(MakeSensor(options_)),
      frame_builder_(MakeFrameBuilder(sensor_, options_)),
      pipeline_(BeginPipeline()),
      runner_(MakeRunner()),
      known_map_(map()) {}

System::~System() = default;

std::unique_ptr<Pipeline> System::BeginPipeline() {
  Check(!start_.localization_only || !start_.map.keyframes().empty(),
        "localization needs a map with keyframes");
  Check(!start_.world_from_cam || start_.world_from_cam->ToMatrix().allFinite(),
        "the pose at which the map is to begin is not finite");
  RequireSameVocabulary(start_.map, options_.vocabulary.get());
  vector_length_ = 0;
  for (const auto& [id, keyframe] : start_.map.keyframes()) {
    CheckVectors(*keyframe.frame);
  }
  auto pipeline = MakePipeline(kind_, sensor_, options_);
  pipeline->Begin({.map = start_.map.Snapshot(),
                   .session = {.name = start_.session_name, .first_frame = start_.map.NextFrame()},
                   .localization_only = start_.localization_only,
                   .world_from_cam = start_.world_from_cam});
  is_localization_only_ = start_.localization_only;
  return pipeline;
}

TrackedFrame System::Track(double timestamp, const cv::Mat& image, const cv::Mat& second,
                           std::vector<InstanceMask> masks, std::vector<InstanceMask> right_masks,
                           const std::optional<MotionPrior>& motion) {
  const bool is_stereo = options_.sensor == SensorKind::kStereo;
  ImageInput input{timestamp, ToGrey(image, options_.rgb_order), cv::Mat(), std::move(masks)};
  input.right_masks = std::move(right_masks);
  input.motion = motion;
  if (!second.empty()) {
    (is_stereo ? input.right : input.depth) =
        is_stereo ? ToGrey(second, options_.rgb_order) : second;
  }
  return Track(input);
}

TrackedFrame System::Track(const ImageInput& image) {
  CheckStamp(image.timestamp);
  return Track(Build(image));
}

BuiltFrame System::Build(const ImageInput& image) {
  for (const auto* const masks : {&image.masks, &image.right_masks}) {
    ValidateMasks(*masks, options_.camera.width, options_.camera.height);
  }
  BuiltFrame built =
      frame_builder_->Build(image, *runner_, awaits_masks_, kind_ != PipelineKind::kRealtime);
  FitDepthError(image);
  return built;
}

// A depth may be taken from half of a pixel of the depth image beside the keypoint, and the
// disparity of a depth camera is known to a part of a pixel of its own. The frame with the first
// depth image is not tracked yet, so nobody has used the error of a depth.
void System::FitDepthError(const ImageInput& image) {
  if (has_depth_size_ || image.depth.empty()) {
    return;
  }
  has_depth_size_ = true;
  const double ratio = static_cast<double>(image.grey.cols) / image.depth.cols;
  if (ratio > 1.0) {
    options_.depth.error.disparity_sigma *= ratio;
    sensor_.depth_error = options_.depth.error;
    frame_builder_->Warn(fmt::format(
        "the depth images of {}x{} px are fitted to the images of {}x{} px; depth.disparity_sigma "
        "becomes {:g}",
        image.depth.cols, image.depth.rows, image.grey.cols, image.grey.rows,
        options_.depth.error.disparity_sigma));
  }
}

std::vector<std::string> System::warnings() const { return frame_builder_->warnings(); }

TrackedFrame System::Track(BuiltFrame built) {
  CheckStamp(built.frame->timestamp);
  CheckMotion(*built.frame);
  CheckVectors(*built.frame);
  built.frame->id = FrameId(start_.map.NextFrame().value + static_cast<uint32_t>(frames_.size()));
  times_.Add("frame", built.milliseconds);
  mask_counts_.Add(built.masks);
  pipeline_->KeepIdsSince(OldestRevision());
  FrameReport report = [&] {
    const ScopedFlag flag(is_tracking_);
    return pipeline_->Track(std::move(built.frame));
  }();
  report.events = TakeEvents();
  AddEventsOfCamera(frames_.all(), report);
  if (kind_ == PipelineKind::kRealtime) {
    times_.Add("track", std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() -
                                                                  built.begin)
                            .count());
  }
  frames_.push_back(report.tracked);
  KeepAwaiting(report, std::move(built.awaiting));
  if (!is_localization_only_ && options_.tracking.refine_at_end) {
    remembered_.push_back(Remember(report, sensor_.camera, options_.objects));
    FinishOldest(*pipeline_, sensor_, options_, remembered_, frames_.all());
  }
  if (frame_callback_) {
    frame_callback_(report);
  }
  return frames_.back();
}

// The events of the map since the last call.
std::vector<MapEvent> System::TakeEvents() {
  static const Map kNoMap;
  std::shared_ptr<const Map> newest = map();
  if (newest == known_map_) {
    return {};
  }
  const std::shared_ptr<const Map> before = std::exchange(known_map_, std::move(newest));
  return EventsBetween(before != nullptr ? *before : kNoMap, *known_map_);
}

void System::AwaitMasks(bool is_on) {
  awaits_masks_ = is_on;
  pipeline_->AwaitMasks(is_on);
}

void System::KeepAwaiting(const FrameReport& report, std::shared_ptr<const DetectionInput> input) {
  const TrackedFrame& tracked = report.tracked;
  if (input != nullptr) {
    AwaitingFrame& awaiting = awaiting_.emplace_back();
    awaiting.frame = tracked.frame;
    awaiting.timestamp = tracked.timestamp;
    awaiting.input = std::move(input);
    if (tracked.state == TrackingState::kTracked && tracked.from_keyframe &&
        tracked.prior != PriorUse::kAlone && !is_localization_only_) {
      awaiting.request = KeyframeRequest{.frame = report.frame,
                                         .pose = *tracked.from_keyframe,
                                         .landmarks = report.landmarks,
                                         .sightings = {},
                                         .oldest_revision = report.map_revision};
    }
  }
  std::erase_if(awaiting_, [&](const AwaitingFrame& former) {
    return tracked.timestamp - former.timestamp > kMaskPatience;
  });
}

bool System::AddMasks(FrameId frame, std::vector<InstanceMask> masks) {
  ValidateMasks(masks, options_.camera.width, options_.camera.height);
  const auto found = std::ranges::find(awaiting_, frame, &AwaitingFrame::frame);
  if (found == awaiting_.end()) {
    return false;
  }
  SerialRunner runner;  // the other one may be building a frame
  BuiltFrame built{.frame = std::make_unique<Frame>(), .masks = {}, .begin = {}};
  frame_builder_->AddDetections(masks, *found->input, runner, built);
  CheckVectors(*built.frame);
  mask_counts_.Add(built.masks);
  if (found->request) {
    found->request->oldest_revision = 0;  // other requests say what may be forgotten
  }
  pipeline_->Edit(
      LateDetections{.frame = frame,
                     .detections = std::move(built.frame->detections),
                     .keypoints = found->input->keypoints.size(),
                     .dynamic_keypoints = frame_builder_->DynamicKeypoints(masks, *found->input),
                     .request = std::move(found->request)});
  awaiting_.erase(found);
  return true;
}

void System::NameObject(ObjectId object, std::string name) {
  if (!ObjectLandmark::IsName(name)) {
    throw InputError(fmt::format(
        "the name \"{}\" of object {} has {} bytes; expected at most 100, of UTF-8 without control "
        "characters",
        ShowText(name), object.value, name.size()));
  }
  Edit({.object = object, .name = std::move(name)});
}

void System::LockObject(ObjectId object, bool is_locked) {
  Edit({.object = object, .is_locked = is_locked});
}

void System::SetObjectSize(ObjectId object, double longest_side) {
  if (longest_side != 0.0 && !ObjectLandmark::IsSize(longest_side)) {
    throw InputError(fmt::format(
        "the longest side of object {} is {:g} m; expected 0.001 to 100 m, or 0 to take it back",
        object.value, longest_side));
  }
  Edit({.object = object, .known_size = longest_side});
}

void System::DeleteObject(ObjectId object) { Edit({.object = object, .is_deleted = true}); }

void System::Edit(ObjectEdit edit) {
  const std::shared_ptr<const Map> newest = map();
  if (newest == nullptr || !newest->Resolve(edit.object).IsValid()) {
    throw InputError(fmt::format("the map has no object {}; expected an id of Map::objects()",
                                 edit.object.value));
  }
  pipeline_->Edit(std::move(edit));
}

// The revision of the oldest map whose ids are still kept here. Frames are kept in order, so it is
// the revision of the first one of each kind.
uint32_t System::OldestRevision() const {
  uint32_t oldest = UINT32_MAX;
  if (!remembered_.empty()) {
    oldest = remembered_.front().map_revision;
  }
  for (const AwaitingFrame& awaiting : awaiting_) {
    if (awaiting.request) {
      return std::min(oldest, awaiting.request->oldest_revision);
    }
  }
  return oldest;
}

void System::SetLocalizationOnly(bool is_on) {
  const std::shared_ptr<const Map> newest = map();
  Check(!is_on || (newest != nullptr && !newest->keyframes().empty()),
        "localization needs a map with keyframes");
  pipeline_->SetLocalizationOnly(is_on);
  is_localization_only_ = is_on;
}

void System::CheckStamp(double timestamp) const {
  Check(std::isfinite(timestamp), "the time stamp is not a number");
  constexpr double kMost = 1e11;  // s; milliseconds since 1970 are more
  Check(std::abs(timestamp) <= kMost, "the time stamp is too large to be in seconds");
  const double last = frames_.empty() ? -2.0 * kMost : frames_.back().timestamp;
  Check(timestamp > last,
        fmt::format("the time stamp {:.6f} s does not come after that of the frame "
                    "before, {:.6f} s; time stamps must increase",
                    timestamp, last));
}

void System::CheckMotion(const Frame& frame) const {
  if (!frame.motion) {
    return;
  }
  const auto refuse = [&](const std::string& fault) {
    throw InputError(
        fmt::format("the motion prior of the frame at {:.6f} s {}", frame.timestamp, fault));
  };
  if (sensor_.IsMonocular()) {
    refuse("is in metres, expected none for a monocular camera, whose map is not");
  }
  if (frames_.empty()) {
    refuse("is that of the first frame, expected one of a later frame");
  }
  constexpr double kSameStamp = 1e-6;  // s
  const MotionPrior& motion = *frame.motion;
  const double last = frames_.back().timestamp;
  if (!(std::abs(motion.last_timestamp - last) <= kSameStamp)) {
    refuse(fmt::format("begins at {:.6f} s, expected the stamp of the frame before, {:.6f} s",
                       motion.last_timestamp, last));
  }
  constexpr double kTolerance = 1e-3;
  const Rigid3& step = motion.cam_from_last_cam;
  const Eigen::Matrix<double, 6, 6>& covariance = motion.covariance;
  if (!step.translation.allFinite() || !(std::abs(step.rotation.norm() - 1.0) <= kTolerance)) {
    refuse("is not finite, or its quaternion has not the length 1");
  }
  if (!covariance.allFinite() || !covariance.isApprox(covariance.transpose(), kTolerance) ||
      covariance.llt().info() != Eigen::Success) {
    refuse("has a covariance that is not finite, symmetric and positive definite");
  }
}

// Vectors of different lengths are of different networks, and the map could not be queried.
void System::CheckVectors(const Frame& frame) {
  size_t known = vector_length_;
  for (const Detection& detection : frame.detections) {
    const size_t length = detection.embedding.size();
    if (known == 0) {
      known = length;
    } else if (length > 0 && length != known) {
      throw InputError(fmt::format(
          "the vectors of the masks have {} numbers, those of the earlier masks and of the loaded "
          "map have {}; expected vectors of one network",
          length, known));
    }
  }
  vector_length_ = known;  // a frame that is refused changes nothing
}

// A second thread for building frames helps only a live camera, which waits for its poses. A run at
// full speed already uses all cores.
std::unique_ptr<TaskRunner> System::MakeRunner() {
  if (kind_ != PipelineKind::kRealtime) {
    return std::make_unique<SerialRunner>();
  }
  // The number of cores is read from a file, which would take too long for every frame.
  return std::make_unique<IdleCoreRunner>([this, cores = std::thread::hardware_concurrency()] {
    const int busy = 1 + (is_tracking_ ? 1 : 0) + pipeline_->busy_threads();
    return busy < static_cast<int>(cores);
  });
}

void System::Finish(const Cancellation* cancellation, const ProgressCallback& on_map,
                    const ProgressCallback& on_poses) {
  std::vector<LeftIsland> left = FinishRun(*pipeline_, sensor_, options_, remembered_,
                                           frames_.all(), cancellation, on_map, on_poses);
  if (left_islands_.empty()) {  // in a second call the frames of these islands are lost already
    left_islands_ = std::move(left);
  }
  remembered_.clear();
  std::ranges::move(TakeEvents(), std::back_inserter(events_at_end_));
}

void System::Reset() {
  auto frame_builder = MakeFrameBuilder(sensor_, options_);
  pipeline_ = BeginPipeline();  // the old one ends its threads
  frame_builder_ = std::move(frame_builder);
  awaits_masks_ = false;
  awaiting_.clear();
  mask_counts_ = {};
  frames_.clear();
  remembered_.clear();
  left_islands_.clear();
  known_map_ = map();
  events_at_end_.clear();
  times_ = {};
}

std::shared_ptr<const Map> System::map() const { return pipeline_->map(); }

Trajectory System::trajectory() const {
  const std::shared_ptr<const Map> map = pipeline_->map();
  return map != nullptr ? ComposeTrajectory(*map, frames_.all()) : Trajectory();
}

StageTimes System::times() const {
  StageTimes times = times_;
  times.Merge(pipeline_->times());
  const auto& samples = times.samples();
  const auto frame = samples.find("frame");
  const auto pose = samples.find("pose");
  StageTimes all = times;
  if (kind_ != PipelineKind::kRealtime && frame != samples.end() && pose != samples.end()) {
    for (size_t i = 0; i < std::min(frame->second.size(), pose->second.size()); ++i) {
      all.Add("track", frame->second[i] + pose->second[i]);
    }
  }
  return all;
}

const std::vector<ChangedObject>& System::object_changes() const {
  return pipeline_->object_changes();
}

size_t System::contradicted_landmarks() const { return pipeline_->contradicted_landmarks(); }

size_t System::sized_objects() const {
  const std::shared_ptr<const Map> newest = map();
  return newest != nullptr ? MeasureScale(*newest, sensor_, options_.objects.sizes).objects : 0;
}

ObjectCounts System::object_counts() const {
  return CountObjects(mask_counts_, frames_.size(), pipeline_->object_rejections());
}

}  // namespace hullslam
