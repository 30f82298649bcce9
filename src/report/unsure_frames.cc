// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/unsure_frames.h"

#include "hullslam/util/check.h"

namespace hullslam {

std::vector<FrameStretch> FindUnsureStretches(std::span<const TrackedFrame> frames,
                                              std::span<const FrameNote> notes) {
  Check(frames.size() == notes.size(), "each frame needs a note");
  std::vector<FrameStretch> stretches;
  bool is_open = false;  // whether the frame before belongs to the last stretch
  for (size_t i = 0; i < frames.size(); ++i) {
    const bool is_unsure = frames[i].state == TrackingState::kTracked && notes[i].is_unsure;
    if (is_unsure && !is_open) {
      stretches.emplace_back();
    }
    if (is_unsure) {
      stretches.back().Add(notes[i].number, frames[i].timestamp);
    }
    is_open = is_unsure;
  }
  return stretches;
}

}  // namespace hullslam
