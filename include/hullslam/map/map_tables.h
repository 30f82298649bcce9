// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hullslam/map/keyframe.h"
#include "hullslam/map/landmark.h"
#include "hullslam/map/object_landmark.h"
#include "hullslam/util/cow_table.h"
#include "hullslam/util/id.h"
#include "hullslam/util/recycling_table.h"

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

// The contents of a map, from which a stored map is restored. A map also remembers which ids were
// replaced, for messages that are under way; that is not stored, because no message survives its
// run.
struct MapTables {
  CowTable<KeyframeId, Keyframe, 1> keyframes;
  RecyclingTable<LandmarkId, Landmark> landmarks;
  CowTable<ObjectId, ObjectLandmark, 4> objects;
  CowTable<KeyframeId, CulledKeyframe> culled;
  std::vector<Session> sessions;  // in the order in which they began
  uint32_t correction_count = 0;
};

}  // namespace hullslam
