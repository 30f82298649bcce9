// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/track_history.h"

namespace hullslam {

void TrackHistory::Add(const TrackedFrame& frame) {
  const bool is_kept = count_++ % stride_ == 0;
  if (frame.state != TrackingState::kTracked) {
    return;
  }
  newest_ = frame;
  if (!is_kept) {
    return;
  }
  if (frames_.size() >= most_) {
    size_t kept = 0;
    for (size_t i = 0; i < frames_.size(); i += 2) {
      frames_[kept++] = frames_[i];
    }
    frames_.resize(kept);
    stride_ *= 2;
    ++thinnings_;
  }
  frames_.push_back(frame);
}

std::vector<TrackedFrame> TrackHistory::frames() const {
  std::vector<TrackedFrame> frames = frames_;
  if (newest_ && (frames.empty() || newest_->timestamp > frames.back().timestamp)) {
    frames.push_back(*newest_);
  }
  return frames;
}

}  // namespace hullslam
