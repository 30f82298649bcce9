// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/frame_source.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "hullslam/util/error.h"
#include "run/interrupt.h"

namespace hullslam {

FrameSource::FrameSource(Pace pace, PrefetchPriority priority, const ImageSequence& sequence,
                         const PinholeCamera& camera, const SequenceMasks& masks, System& system)
    : is_realtime_(pace == Pace::kRealtime),
      sequence_(sequence),
      camera_(camera),
      masks_(masks),
      system_(system),
      images_([this] { return LoadNext(); }, kImagesAhead, priority),
      frames_([this] { return BuildNext(); }, kFramesAhead, priority) {}

FrameSource::~FrameSource() {
  end_.Request();
  loads_.release();
}

std::optional<LoadedFrame> FrameSource::Next() {
  if (is_realtime_) {
    loads_.release();
  }
  return frames_.Next();
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
  LoadedImage loaded;
  try {
    loaded.image = sequence_.load(sequence_.frames[frame], camera_);
  } catch (const InputError& error) {
    loaded.error = error.what();
  }
  if (loaded.image) {
    loaded.image->masks = masks_.Read(frame);
  }
  return loaded;
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
  return LoadedFrame{.frame = system_.Build(*loaded->image), .error = {}};
}

// Waits until the time, counted from the start, at which the camera took the frame. Returns false
// if the run ends before.
bool FrameSource::WaitFor(double stamp) const {
  constexpr std::chrono::milliseconds kStep(20);
  const std::chrono::duration<double> after_start(stamp - sequence_.frames.front().timestamp);
  const auto due = start_ + std::chrono::duration_cast<Clock::duration>(after_start);
  const auto is_over = [this] { return IsInterrupted() || end_.IsRequested(); };
  while (!is_over() && Clock::now() < due) {
    std::this_thread::sleep_until(std::min(due, Clock::now() + kStep));
  }
  return !is_over();
}

}  // namespace hullslam
