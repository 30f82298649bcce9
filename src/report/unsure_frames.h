// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "report/lost_frames.h"

namespace hullslam {

// The stretches of frames whose poses are unsure (TrackedFrame::is_unsure), in order of time.
// `frames` are the frames at the end of the run, and `notes` has one entry for each of them. A
// frame without a pose at the end is not unsure but lost.
std::vector<FrameStretch> FindUnsureStretches(std::span<const TrackedFrame> frames,
                                              std::span<const FrameNote> notes);

}  // namespace hullslam
