// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"

namespace hullslam {

// The tracked frames of a run for its path in a viewer. It keeps at most `most` of them, evenly
// chosen, and the newest one, so that its memory does not grow with the length of the run.
class TrackHistory {
 public:
  explicit TrackHistory(size_t most) : most_(most) {}

  void Add(const TrackedFrame& frame);

  // The frames that are kept, and the newest one, so that the path reaches the camera.
  std::vector<TrackedFrame> frames() const;
  // Counts how often frames were removed. As long as it stays the same, frames are only added.
  size_t thinnings() const { return thinnings_; }

 private:
  const size_t most_;
  std::vector<TrackedFrame> frames_;
  std::optional<TrackedFrame> newest_;
  size_t stride_ = 1;
  size_t count_ = 0;  // frames that were given
  size_t thinnings_ = 0;
};

// The data of one frame. Large parts are shared, so handing it over takes microseconds.
struct LiveFrame {
  FrameReport report = {};
  std::shared_ptr<const Map> map = {};  // null before the first keyframe
  cv::Mat grey = {};                    // the image in raw pixels, CV_8UC1; may be empty
  size_t number = 0;                    // of the frame in the run, counted from 1
  double build_ms = 0.0;                // time of finding features
  double track_ms = 0.0;                // time of tracking, and in a sequential run of mapping
};

// A stretch of frames without a pose that has ended.
struct LiveLoss {
  double from = 0.0;  // time stamps of its first and its last frame, s
  double to = 0.0;
  size_t frames = 0;
  std::string reason;  // why its first frame is lost
};

// The knowledge of the viewer about the run at one moment.
struct LiveState {
  std::shared_ptr<const Map> map;  // of the last frame; null before the first keyframe
  std::vector<TrackedFrame> path;  // evenly chosen; their keyframes are in the map
  size_t path_thinnings = 0;       // TrackHistory::thinnings()
  std::vector<LiveLoss> losses;    // the latest ones
  size_t loss_count = 0;           // all that there were
};

// The buffer with room for one frame between the thread that tracks and the viewer. Newer frames
// replace older ones, so neither waits and nothing grows. Only what is needed to draw the
// path is kept of each frame.
class LiveInbox {
 public:
  void Put(LiveFrame frame);

  // The newest frame, if there is one that was not taken yet.
  std::optional<LiveFrame> TakeFrame();
  LiveState state() const;
  // Frames per second in the last seconds; 0 if unknown.
  double rate() const;

 private:
  void NoteLoss(const FrameReport& report);
  void NoteTime();

  static constexpr size_t kMostPath = 4000;  // frames
  static constexpr size_t kMostLosses = 200;
  static constexpr size_t kTimes = 64;

  mutable std::mutex mutex_;  // guards the members below
  std::optional<LiveFrame> frame_;
  std::shared_ptr<const Map> map_;
  TrackHistory path_{kMostPath};
  std::vector<LiveLoss> losses_;
  size_t loss_count_ = 0;
  std::optional<LiveLoss> open_loss_;
  std::vector<double> times_;  // s, when the last frames came
};

}  // namespace hullslam
