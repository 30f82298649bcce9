// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synthetic/scene_builder.h"

namespace hullslam::synthetic {

// Adds a plain room of 6 m x 5.6 m with a laid table in its middle, whose top is 0.72 m high. Most
// dishes are hollow and have little texture.
void FurnishDishes(SceneBuilder& builder);

}  // namespace hullslam::synthetic
