// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_inbox.h"

#include <chrono>
#include <utility>

#include "hullslam/map/tracking_failure.h"

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

void LiveInbox::Put(LiveFrame frame) {
  // These are released without the lock, because freeing a map may take long.
  std::optional<LiveFrame> old;
  std::shared_ptr<const Map> old_map = frame.map;
  const std::lock_guard lock(mutex_);
  map_.swap(old_map);
  path_.Add(frame.report.tracked);
  NoteLoss(frame.report);
  NoteTime();
  old = std::exchange(frame_, std::move(frame));
}

std::optional<LiveFrame> LiveInbox::TakeFrame() {
  const std::lock_guard lock(mutex_);
  return std::exchange(frame_, std::nullopt);
}

LiveState LiveInbox::state() const {
  const std::lock_guard lock(mutex_);
  return {.map = map_,
          .path = path_.frames(),
          .path_thinnings = path_.thinnings(),
          .losses = losses_,
          .loss_count = loss_count_};
}

double LiveInbox::rate() const {
  const std::lock_guard lock(mutex_);
  const double seconds = times_.empty() ? 0.0 : times_.back() - times_.front();
  return seconds > 0.0 ? static_cast<double>(times_.size() - 1) / seconds : 0.0;
}

void LiveInbox::NoteLoss(const FrameReport& report) {
  const TrackedFrame& tracked = report.tracked;
  if (tracked.state == TrackingState::kLost) {
    if (!open_loss_) {
      open_loss_ = LiveLoss{.from = tracked.timestamp,
                            .to = 0.0,
                            .frames = 0,
                            .reason = report.loss ? std::string(ToString(*report.loss)) : ""};
    }
    open_loss_->to = tracked.timestamp;
    ++open_loss_->frames;
  } else if (open_loss_) {
    if (losses_.size() == kMostLosses) {
      losses_.erase(losses_.begin());
    }
    losses_.push_back(*std::exchange(open_loss_, std::nullopt));
    ++loss_count_;
  }
}

void LiveInbox::NoteTime() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  if (times_.size() == kTimes) {
    times_.erase(times_.begin());
  }
  times_.push_back(std::chrono::duration<double>(now).count());
}

}  // namespace hullslam
