// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "hullslam/system/system.h"

namespace hullslam {

template <typename Task, typename Result>
class LatestMaker;

// Makes masks of frames after they were tracked, and adds them to the system (System::AddMasks).
// Only keyframes keep masks, so masks are made of keyframes only.
class LateMasks {
 public:
  // The masks of an image in its pixels; absent if the network fails on it. Then the image says
  // nothing about objects.
  using Maker = std::function<std::optional<std::vector<InstanceMask>>(const cv::Mat& image)>;
  enum class Pace {
    kWait,  // AfterFrame makes the masks of a keyframe at once: reproducible
    // A thread makes the masks of the newest keyframe without masks whenever it is free, and they
    // are added when they are ready.
    kNeverWait,
  };
  // With kNeverWait another thread calls `make`. The system must outlive this object.
  LateMasks(Pace pace, Maker make, System& system);
  ~LateMasks();
  LateMasks(const LateMasks&) = delete;
  LateMasks& operator=(const LateMasks&) = delete;

  // To be called after each frame, by the thread of System::Track. `image` is in colour and must
  // not change any more; it is empty if the masks of the frame were made before it was tracked.
  void AfterFrame(const TrackedFrame& frame, const cv::Mat& image);
  // To be called before System::Finish: waits for the masks that are being made.
  void Finish();

 private:
  struct Picture {
    FrameId frame;
    double timestamp = 0.0;
    cv::Mat image;
  };
  struct Made {
    FrameId frame;
    std::optional<std::vector<InstanceMask>> masks;  // absent if the network has failed
  };
  bool IsKeyframe(FrameId frame) const;
  void AddMade();
  void BeginNext();

  const Pace pace_;
  const Maker make_;
  System& system_;
  std::deque<Picture> pictures_;  // of the frames that may still get masks
  std::unique_ptr<LatestMaker<Picture, Made>> worker_;
};

}  // namespace hullslam
