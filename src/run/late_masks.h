// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "hullslam/system/system.h"
#include "run/network_masks.h"
#include "util/latest_maker.h"

namespace hullslam {

// Makes masks of frames after they were tracked, and adds them to the system (System::AddMasks).
// Only keyframes keep masks, so masks are made of keyframes only. A keyframe whose image the
// network fails on says nothing about objects.
class LateMasks {
 public:
  enum class Pace {
    kWait,  // AfterFrame makes the masks of a keyframe at once: reproducible
    // A thread makes the masks of the newest keyframe without masks whenever it is free, and they
    // are added when they are ready.
    kNeverWait,
  };
  // The references must outlive this object.
  LateMasks(Pace pace, const NetworkMasks& network, System& system);

  // To be called after each frame, by the thread of System::Track. `image` is in colour; it is
  // empty if the masks of the frame were made before it was tracked.
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
  const NetworkMasks& network_;
  System& system_;
  std::deque<Picture> pictures_;  // of the frames that may still get masks
  std::unique_ptr<LatestMaker<Picture, Made>> worker_;
};

}  // namespace hullslam
