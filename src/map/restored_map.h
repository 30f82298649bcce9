// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/bow/vocabulary.h"
#include "hullslam/map/map.h"
#include "hullslam/map/map_tables.h"

namespace hullslam {

// Makes a map of tables that may have been made by anybody. What follows from other values may be
// missing in them: Keyframe::children, Landmark::observations, Landmark::observation_weight and
// ObjectLandmark::observations. The frames must be consistent in themselves: one entry of each list
// per keypoint, one entry of Keyframe::landmarks per keypoint and of Keyframe::objects per
// detection. Throws InputError with the first fault if no map can have such tables: it then names
// the entity. `vocabulary` is that of the words of the frames; null: the map will have no index,
// and the words are not checked.
Map RestoreMap(MapTables tables, std::shared_ptr<const Vocabulary> vocabulary = nullptr);

}  // namespace hullslam
