// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// The frames of a monocular run that get a pose, or a better one, at the end of the run: those
// before the map and before each new island, which had none, and those that were tracked while
// their island was young.
class EarlyFrames {
 public:
  // Frames come in order of time. At most 300 are kept; the oldest ones are forgotten first.
  void Keep(std::shared_ptr<const Frame> frame);

  // Finds the frames in the final map and forgets them. Frames that are not found are left out.
  // `context` has the object index of this map.
  std::vector<TrackedFrame> Localise(const Map& map, const TrackingContext& context);

 private:
  std::vector<std::shared_ptr<const Frame>> frames_;  // in order of time
};

}  // namespace hullslam
