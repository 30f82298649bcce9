// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/util/cancellation.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// The rules, which depend on the sensor, for the beginning of a map or of a new island
// (Map::BeginIsland).
struct IslandRules {
  // Whether an island can only begin with several frames, between which the camera moves. The
  // frames before have no poses, and the poses of the first frames after it are uncertain. So the
  // poses of these frames are computed at the end of the run.
  bool needs_motion = false;
  // Whether a camera that is lost in a young island begins a new one at once.
  bool begins_at_once = false;

  static IslandRules ForSensor(SensorKind kind) {
    const bool is_monocular = kind == SensorKind::kMonocular;
    // With depth, one frame makes a map. Without depth the first points are triangulated, which
    // needs motion. The search for this motion is a wait already. With depth a camera that is lost
    // must wait first, because otherwise a single blurred image would begin an island.
    return {.needs_motion = is_monocular, .begins_at_once = is_monocular};
  }
};

// The frames that get a pose, or a better one, at the end of the run: those that were lost, those
// before a monocular map, and those that were tracked while their monocular island was young.
class EarlyFrames {
 public:
  // Frames come in order of time. At most 300 are kept. The oldest ones that have a pose, because
  // they were tracked, are forgotten first: a camera that stands still in a young island would
  // otherwise push out those without a pose. Then the oldest of the others are forgotten.
  void Keep(std::shared_ptr<const Frame> frame, bool is_tracked);

  // Finds one of the frames without a pose that shows enough that the map lacks to become a
  // keyframe. A frame that was not found is tried again when there are other keyframes to compare
  // it with. Null if no frame is found.
  std::optional<KeyframeRequest> FindKeyframe(const Map& map, const TrackingContext& context);

  // Finds the frames in the final map and forgets them. Each is sought at the keyframe that is
  // nearest in time. A frame that is not found there is tracked from the frame after it: the first
  // images of a car show the landmarks of the map far ahead, too small to be recognised, but hardly
  // different from one image to the next. Frames that are not found are left out, and so are those
  // that are left when `cancellation` (may be null) is requested. `on_progress` is called after
  // each frame. `context` has the object index of this map.
  std::vector<TrackedFrame> Localise(const Map& map, const TrackingContext& context,
                                     const Cancellation* cancellation = nullptr,
                                     const ProgressCallback& on_progress = {});

 private:
  struct Kept {
    std::shared_ptr<const Frame> frame;
    bool is_tracked = false;
    // The keyframes with which FindKeyframe has compared the frame last.
    std::vector<KeyframeId> compared = {};
  };
  std::vector<Kept> frames_;  // in order of time
};

}  // namespace hullslam
