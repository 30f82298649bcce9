// SPDX-License-Identifier: GPL-3.0-or-later
#include "live_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "hullslam/util/cancellation.h"
#include "hullslam/util/error.h"

namespace hullslam::python {
namespace {

constexpr double kMostSeconds = 1e11;  // as in files/plausible.h; milliseconds since 1970 are more
constexpr double kLongestPause = 1e6;  // s, eleven days; no run has such a pause between frames

// All systems that exist, so that their threads can be ended before the program ends.
struct Registry {
  std::mutex mutex;
  std::set<LiveSystem*> systems;
};

Registry& TheRegistry() {
  static Registry registry;
  return registry;
}

}  // namespace

void CheckStamp(double timestamp) {
  if (!std::isfinite(timestamp)) {
    throw InputError("timestamp is not finite, expected seconds");
  }
  if (std::abs(timestamp) > kMostSeconds) {
    throw InputError(
        fmt::format("timestamp is {:g}, expected seconds, up to {:g}; those of other "
                    "units must be converted, such as nanoseconds / 1e9",
                    timestamp, kMostSeconds));
  }
}

LiveSystem::LiveSystem(const SystemOptions& options, PipelineKind kind, SystemStart start)
    : options_(options), kind_(kind) {
  Begin(std::move(start));
  Registry& registry = TheRegistry();
  const std::lock_guard lock(registry.mutex);
  registry.systems.insert(this);
}

LiveSystem::~LiveSystem() {
  Registry& registry = TheRegistry();
  const std::lock_guard lock(registry.mutex);
  registry.systems.erase(this);
}

void LiveSystem::CloseAll() {
  Registry& registry = TheRegistry();
  const std::lock_guard lock(registry.mutex);
  for (LiveSystem* const live : registry.systems) {
    const std::lock_guard turn(live->mutex_);
    live->late_masks_.reset();
    live->system_.reset();
  }
}

void LiveSystem::Begin(SystemStart start) {
  if (start.localization_only && start.map.keyframes().empty()) {
    throw InputError("localization needs a map with keyframes, expected map=PATH");
  }
  late_masks_.reset();
  system_ = std::make_unique<System>(options_, kind_, std::move(start));
  system_->SetFrameCallback([this](const FrameReport& report) { report_ = report; });
  taken_warnings_ = 0;
  last_stamp_.reset();
  is_finished_ = false;
}

System& LiveSystem::Open() const {
  if (system_ == nullptr) {
    throw InputError("the system was closed at the exit of the interpreter");
  }
  return *system_;
}

namespace {

// Throws InputError unless a frame has the second image of its mode, and no other one.
void CheckSecond(SensorKind sensor, const SecondImage& second) {
  const bool needs_depth = sensor == SensorKind::kRgbd;
  const bool needs_right = sensor == SensorKind::kStereo;
  if (needs_depth && second.depth.empty()) {
    throw InputError(
        "depth is None, expected a depth image; a camera without depth has the mode "
        "'mono'");
  }
  if (needs_right && second.right.empty()) {
    throw InputError("right is None, expected the right image in the mode 'stereo'");
  }
  if (!needs_depth && !second.depth.empty()) {
    throw InputError(std::string("there is a depth image, expected None in the mode '") +
                     (needs_right ? "stereo'" : "mono'"));
  }
  if (!needs_right && !second.right.empty()) {
    throw InputError(std::string("there is a right image, expected None in the mode '") +
                     (needs_depth ? "rgbd'" : "mono'"));
  }
}

}  // namespace

FrameReport LiveSystem::Track(double timestamp, const cv::Mat& image, const SecondImage& second,
                              std::vector<InstanceMask> masks,
                              std::vector<InstanceMask> right_masks,
                              std::optional<MotionPrior> motion) {
  const std::lock_guard lock(mutex_);
  System& system = Open();
  if (is_finished_) {
    throw InputError("track() was called after finish(); reset() begins a new run");
  }
  CheckStamp(timestamp);
  if (last_stamp_ && !(timestamp > *last_stamp_)) {
    throw InputError("timestamp is " + fmt::format("{:f}", timestamp) +
                     " s, expected more than that of the last frame, " +
                     fmt::format("{:f}", *last_stamp_) + " s");
  }
  if (last_stamp_ && timestamp - *last_stamp_ > kLongestPause) {
    throw InputError("timestamp is " + fmt::format("{:f}", timestamp - *last_stamp_) +
                     " s after that of the last frame, expected seconds, not nanoseconds");
  }
  CheckSecond(options_.sensor, second);
  if (motion) {
    if (!last_stamp_) {
      throw InputError("motion is given for the first frame, expected none");
    }
    motion->last_timestamp = *last_stamp_;
  }
  const cv::Mat unmasked = late_masks_ != nullptr && masks.empty() ? image.clone() : cv::Mat();
  system.Track(timestamp, image, second.right.empty() ? second.depth : second.right,
               std::move(masks), std::move(right_masks), motion);
  last_stamp_ = timestamp;
  if (late_masks_ != nullptr) {
    late_masks_->AfterFrame(report_.tracked, unmasked);
  }
  return std::exchange(report_, {});
}

std::vector<std::string> LiveSystem::TakeWarnings() {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> warnings = Open().warnings();
  const size_t taken = std::min(taken_warnings_, warnings.size());
  taken_warnings_ = warnings.size();
  warnings.erase(warnings.begin(), warnings.begin() + static_cast<std::ptrdiff_t>(taken));
  return warnings;
}

void LiveSystem::Finish(const std::function<bool()>& is_over) {
  const std::lock_guard lock(mutex_);
  System& system = Open();
  Cancellation cancellation;
  const auto ask = [&](int /*done*/, int /*most*/) {
    if (!cancellation.IsRequested() && is_over()) {
      cancellation.Request();
    }
  };
  is_finished_ = true;
  if (late_masks_ != nullptr) {
    late_masks_->Finish();
  }
  system.Finish(&cancellation, ask, ask);
}

void LiveSystem::Reset() {
  const std::lock_guard lock(mutex_);
  late_masks_.reset();
  Open().Reset();
  taken_warnings_ = 0;
  last_stamp_.reset();
  is_finished_ = false;
}

void LiveSystem::Restart(SystemStart start) {
  const std::lock_guard lock(mutex_);
  Open();
  Begin(std::move(start));
}

void LiveSystem::SetLocalizationOnly(bool is_on) {
  const std::lock_guard lock(mutex_);
  System& system = Open();
  const std::shared_ptr<const Map> map = system.map();
  if (is_on && (map == nullptr || map->keyframes().empty())) {
    throw InputError("localization needs a map with keyframes, and there is none yet");
  }
  system.SetLocalizationOnly(is_on);
}

void LiveSystem::AwaitMasks(bool is_on) {
  const std::lock_guard lock(mutex_);
  Open().AwaitMasks(is_on);
}

void LiveSystem::MakeMasks(LateMasks::Pace pace, LateMasks::Maker make) {
  const std::lock_guard lock(mutex_);
  late_masks_ = std::make_unique<LateMasks>(pace, std::move(make), Open());
}

ObjectId LiveSystem::IdOfObject(int64_t object) const {
  if (is_finished_) {
    throw InputError("an object was changed after finish(); reset() begins a new run");
  }
  if (object < 0 || object >= std::numeric_limits<uint32_t>::max()) {
    throw InputError("the map has no object " + std::to_string(object) +
                     "; expected an id of map.objects");
  }
  return ObjectId(static_cast<uint32_t>(object));
}

bool LiveSystem::AddMasks(int64_t frame, std::vector<InstanceMask> masks) {
  const std::lock_guard lock(mutex_);
  System& system = Open();
  if (is_finished_) {
    throw InputError("add_masks() was called after finish(); reset() begins a new run");
  }
  constexpr int64_t kMost = std::numeric_limits<uint32_t>::max();
  return frame >= 0 && frame < kMost &&
         system.AddMasks(FrameId(static_cast<uint32_t>(frame)), std::move(masks));
}

}  // namespace hullslam::python
