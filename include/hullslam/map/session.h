// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "hullslam/util/id.h"

namespace hullslam {

// A run that has added keyframes to the map.
struct Session {
  std::string name;  // such as the name of the sequence
  // Its frames have this id or a larger one. Frames of the next session have still larger ids.
  FrameId first_frame;

  bool operator==(const Session&) const = default;
};

// The number of the session of this frame, counted from 1; 0 if the frame is older than all
// sessions. `sessions` are in the order in which they began.
size_t SessionNumber(std::span<const Session> sessions, FrameId frame);

}  // namespace hullslam
