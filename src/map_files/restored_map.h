// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/bow/vocabulary.h"
#include "hullslam/map/map.h"
#include "hullslam/map/map_tables.h"

namespace hullslam {

// Makes a map from tables of unknown origin. They may lack the values that follow from others:
// Keyframe::children, Landmark::observations, Landmark::observation_weight and
// ObjectLandmark::observations. If the islands of all keyframes are invalid, each spanning tree is
// an island. The frames must be consistent in themselves: one entry of each list
// per keypoint, one entry of Keyframe::landmarks per keypoint and of Keyframe::objects per
// detection. Throws InputError if no map can have such tables. The message has the first fault and
// names the entity. `vocabulary` has the words of the frames; null: the map will have no
// index, and the words are not checked.
Map RestoreMap(MapTables tables, std::shared_ptr<const Vocabulary> vocabulary = nullptr);

}  // namespace hullslam
