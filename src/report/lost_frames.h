// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "hullslam/map/messages.h"

namespace hullslam {

// Advice for the user, in one sentence without a full stop.
std::string_view AdviceFor(TrackingFailure reason);

// The result of tracking for a frame, as it was during the run.
struct FrameNote {
  size_t number = 0;  // of the frame in its sequence, counted from 0
  TrackingState state = TrackingState::kNotInitialized;
  std::optional<TrackingFailure> loss = std::nullopt;
  bool is_unsure = false;  // TrackedFrame::is_unsure
};

// Frames in a row.
struct FrameStretch {
  size_t first_frame = 0;  // as FrameNote::number
  size_t last_frame = 0;
  double first_timestamp = 0.0;  // s
  double last_timestamp = 0.0;
  size_t frames = 0;

  // Adds the next frame.
  void Add(size_t number, double timestamp);
};

// Frames in a row that have no pose. `reason` belongs to the first one: the others are lost because
// it was lost.
struct LostStretch : FrameStretch {
  TrackingFailure reason = TrackingFailure::kNotRecognised;
};

// The stretches of a run in order of time. `frames` are the frames at its end, and `notes` has one
// entry for each of them. Frames of islands that were not joined are in stretches of their own.
std::vector<LostStretch> FindLostStretches(std::span<const TrackedFrame> frames,
                                           std::span<const FrameNote> notes);

// The stretches of frames whose poses are unsure (TrackedFrame::is_unsure), in order of time.
// `frames` are the frames at the end of the run, and `notes` has one entry for each of them. A
// frame without a pose at the end is not unsure but lost.
std::vector<FrameStretch> FindUnsureStretches(std::span<const TrackedFrame> frames,
                                              std::span<const FrameNote> notes);

}  // namespace hullslam
