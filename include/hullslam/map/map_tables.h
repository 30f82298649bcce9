// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "hullslam/map/keyframe.h"
#include "hullslam/map/landmark.h"
#include "hullslam/map/object_landmark.h"
#include "hullslam/map/session.h"
#include "hullslam/util/cow_table.h"
#include "hullslam/util/id.h"
#include "hullslam/util/recycling_table.h"

namespace hullslam {

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
