// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

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

}  // namespace hullslam
