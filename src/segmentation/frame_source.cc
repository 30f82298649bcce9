// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/frame_source.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

std::unique_ptr<LateMasks> MakeLateMasks(bool is_realtime, const NetworkMasks* network,
                                         System& system) {
  if (network == nullptr || network->IsRead(1)) {
    return nullptr;
  }
  return std::make_unique<LateMasks>(
      is_realtime ? LateMasks::Pace::kNeverWait : LateMasks::Pace::kWait,
      [network](const cv::Mat& image) { return network->Make(image); }, system);
}

}  // namespace

FrameSource::FrameSource(Pace pace, const ImageSequence& sequence, const PinholeCamera& camera,
                         const SequenceMasks& masks, System& system, bool keeps_images,
                         const Cancellation* cancellation)
    : is_realtime_(pace == Pace::kRealtime),
      sequence_(sequence),
      camera_(camera),
      masks_(masks),
      system_(system),
      keeps_images_(keeps_images),
      cancellation_(cancellation),
      late_masks_(MakeLateMasks(is_realtime_, masks.network(), system)),
      images_([this] { return LoadNext(); }, kImagesAhead),
      frames_([this] { return BuildNext(); }, kFramesAhead) {}

FrameSource::~FrameSource() {
  end_.Request();
  loads_.release();
}

std::optional<LoadedFrame> FrameSource::Next() {
  if (is_realtime_) {
    loads_.release();
  }
  std::optional<LoadedFrame> next = frames_.Next();
  if (next && next->frame) {
    next->frame->begin += Delay() - next->delay;
  }
  return next;
}

TrackedFrame FrameSource::Track(LoadedFrame& loaded) {
  const std::span<const TrackedFrame> tracked = system_.frames();
  if (!tracked.empty()) {
    Frame& next = *loaded.frame->frame;
    next.motion = PriorBetween(sequence_, tracked.back().timestamp, next.timestamp,
                               system_.options().odometry);
  }
  const TrackedFrame frame = system_.Track(std::move(*loaded.frame));
  if (late_masks_ != nullptr && !loaded.has_unknown_masks) {
    late_masks_->AfterFrame(frame, loaded.colour);
  }
  return frame;
}

void FrameSource::Finish() {
  if (late_masks_ != nullptr) {
    late_masks_->Finish();
  }
}

void FrameSource::Pause() {
  pause_begin_ = Clock::now();
  is_paused_ = true;
}

void FrameSource::Resume() {
  if (is_paused_) {
    delay_ += (Clock::now() - pause_begin_).count();
    is_paused_ = false;
  }
}

// An image that cannot be read is reported in LoadedImage, so that the frame can be skipped. Masks
// that cannot be read end the run, because a frame without its masks would look like a frame
// without objects.
std::optional<FrameSource::LoadedImage> FrameSource::LoadNext() {
  if (next_ == sequence_.frames.size()) {
    return std::nullopt;
  }
  if (is_realtime_) {
    loads_.acquire();
  }
  if (end_.IsRequested()) {
    return std::nullopt;
  }
  const size_t frame = next_++;
  const NetworkMasks* const network = masks_.network();
  LoadedImage loaded;
  try {
    loaded.image = sequence_.load(sequence_.frames[frame], camera_);
    if (network != nullptr) {
      loaded.colour = network->LoadImage(frame);
    }
  } catch (const InputError& error) {
    loaded = {.image = std::nullopt, .error = error.what()};
  }
  if (loaded.image) {
    AddMasks(frame, loaded);
  }
  return loaded;
}

void FrameSource::AddMasks(size_t frame, LoadedImage& loaded) const {
  if (const NetworkMasks* const network = masks_.network()) {
    if (network->IsRead(frame)) {
      auto masks = network->Make(std::exchange(loaded.colour, {}));
      loaded.has_unknown_masks = !masks;
      loaded.image->masks = masks ? *std::move(masks) : std::vector<InstanceMask>();
    }
    return;
  }
  loaded.image->masks = masks_.Read(frame);
  FitMasks(sequence_.warps, ImageSide::kLeft, loaded.image->masks);
  loaded.image->right_masks = masks_.ReadRight(frame);
  FitMasks(sequence_.warps, ImageSide::kRight, loaded.image->right_masks);
}

std::optional<LoadedFrame> FrameSource::BuildNext() {
  std::optional<LoadedImage> loaded = images_.Next();
  if (!loaded) {
    return std::nullopt;
  }
  if (!loaded->image) {
    return LoadedFrame{.frame = std::nullopt, .error = std::move(loaded->error)};
  }
  if (is_realtime_ && !WaitFor(loaded->image->timestamp)) {
    return std::nullopt;
  }
  const Clock::duration delay = Delay();
  BuiltFrame built = system_.Build(*loaded->image);
  const double milliseconds = built.milliseconds;
  return LoadedFrame{.frame = std::move(built),
                     .error = {},
                     .grey = keeps_images_ ? loaded->image->grey : cv::Mat(),
                     .colour = loaded->colour,
                     .has_unknown_masks = loaded->has_unknown_masks,
                     .build_ms = milliseconds,
                     .delay = delay};
}

// Waits until the time, counted from the start, at which the camera took the frame. Returns false
// if the run ends before.
bool FrameSource::WaitFor(double stamp) const {
  constexpr std::chrono::milliseconds kStep(20);
  const std::chrono::duration<double> after_start(stamp - sequence_.frames.front().timestamp);
  const auto due = [&] {
    return start_ + std::chrono::duration_cast<Clock::duration>(after_start) + Delay();
  };
  const auto is_over = [this] {
    return end_.IsRequested() || (cancellation_ != nullptr && cancellation_->IsRequested());
  };
  while (!is_over() && (is_paused_ || Clock::now() < due())) {
    const Clock::time_point next = Clock::now() + kStep;
    std::this_thread::sleep_until(is_paused_ ? next : std::min(due(), next));
  }
  return !is_over();
}

}  // namespace hullslam
