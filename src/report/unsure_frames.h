// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "report/lost_frames.h"

namespace hullslam {

// Frames in a row whose poses are unsure (TrackedFrame::is_unsure).
struct UnsureStretch {
  size_t first_frame = 0;  // as FrameNote::number
  size_t last_frame = 0;
  double first_timestamp = 0.0;  // s
  double last_timestamp = 0.0;
  size_t frames = 0;
};

// The stretches of a run in order of time. `frames` are those at its end, and `notes` has one entry
// for each of them. A frame without a pose at the end is not unsure but lost.
std::vector<UnsureStretch> FindUnsureStretches(std::span<const TrackedFrame> frames,
                                               std::span<const FrameNote> notes);

}  // namespace hullslam
