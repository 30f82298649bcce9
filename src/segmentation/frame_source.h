// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <semaphore>
#include <string>

#include "hullslam/camera/pinhole.h"
#include "hullslam/segmentation/late_masks.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/system/system.h"
#include "hullslam/util/cancellation.h"
#include "segmentation/sequence_masks.h"
#include "system/prefetcher.h"

namespace hullslam {

// A frame that can be tracked, or the reason why its image could not be loaded.
struct LoadedFrame {
  std::optional<BuiltFrame> frame;
  std::string error;
  cv::Mat grey = {};  // the image; empty unless images are kept
  // The image in colour, if a network is to make masks of it after the frame was tracked; else
  // empty.
  cv::Mat colour = {};
  bool has_unknown_masks = false;                  // the network has failed on the image
  double build_ms = 0.0;                           // time of building
  std::chrono::steady_clock::duration delay = {};  // FrameSource::Pause() up to then, in all
};

// The pace at which frames become available: as fast as they can be read, or at their time stamps.
enum class Pace { kFast, kRealtime };

// Loads the images of a sequence in one thread and builds their frames in another one, ahead of
// tracking. In real time a frame is not built before the time at which the camera took it, and an
// image is only loaded when the last frame has been tracked, so that loading takes no core from
// tracking.
class FrameSource {
 public:
  // The references must outlive this object. With Pace::kRealtime, the clock starts now, at the
  // first time stamp; a request of `cancellation` then ends the frames.
  // `keeps_images` says whether frames come with their images.
  FrameSource(Pace pace, const ImageSequence& sequence, const PinholeCamera& camera,
              const SequenceMasks& masks, System& system, bool keeps_images = false,
              const Cancellation* cancellation = nullptr);
  ~FrameSource();
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;

  // The next frame; null at the end, and in real time also after a cancellation. To be called when
  // the frames before have been tracked. Throws InputError if the masks of a frame cannot be read.
  std::optional<LoadedFrame> Next();

  // Tracks this frame. Without masks in time, those of keyframes are made by the network: with
  // Pace::kFast at once, in real time when it is free (LateMasks).
  TrackedFrame Track(LoadedFrame& loaded);
  // To be called after the last frame, before System::Finish: waits for masks that are being made.
  void Finish();

  // Stops the clock of a run in real time until Resume(), so that a pause is no delay of the frames
  // after it. Called by the thread that calls Next(). Resume() without Pause() does nothing.
  void Pause();
  void Resume();

 private:
  // An image, or the reason why it could not be loaded.
  struct LoadedImage {
    std::optional<ImageInput> image;
    std::string error;
    cv::Mat colour = {};
    bool has_unknown_masks = false;
  };
  using Clock = std::chrono::steady_clock;

  static constexpr size_t kImagesAhead = 4;
  static constexpr size_t kFramesAhead = 4;

  std::optional<LoadedImage> LoadNext();
  void AddMasks(size_t frame, LoadedImage& loaded) const;
  std::optional<LoadedFrame> BuildNext();
  bool WaitFor(double stamp) const;
  // The sum of all pauses so far.
  Clock::duration Delay() const { return Clock::duration(delay_.load()); }

  const bool is_realtime_;
  const ImageSequence& sequence_;
  const PinholeCamera& camera_;
  const SequenceMasks& masks_;
  System& system_;
  const bool keeps_images_;
  const Cancellation* const cancellation_;  // may be null
  std::unique_ptr<LateMasks> late_masks_;   // null if all frames are tracked with their masks
  const Clock::time_point start_ = Clock::now();
  std::atomic<Clock::rep> delay_ = 0;
  std::atomic<bool> is_paused_ = false;
  Clock::time_point pause_begin_;
  Cancellation end_;
  std::counting_semaphore<> loads_{
      kImagesAhead};  // number of images that may be loaded in real time
  size_t next_ = 0;   // index of the next image to load; used only by the thread that loads
  Prefetcher<LoadedImage> images_;
  Prefetcher<LoadedFrame> frames_;  // last, because its thread uses the others
};

}  // namespace hullslam
