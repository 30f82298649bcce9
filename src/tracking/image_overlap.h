// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/map/map.h"
#include "tracking/last_frame.h"

namespace hullslam {

// The share of the landmarks that a camera at `cam_from_world` has in its image. Ids that are
// invalid or that the map does not have are left out; 1 if none remains.
double ShareInImage(const Map& map, const Sensor& sensor, const Rigid3& cam_from_world,
                    std::span<const LandmarkId> landmarks);

// The share of the view of the keyframe `reference` that the next image will show at least, if the
// camera moves from this frame, at `cam_from_world`, as far as it moved from the last frame to this
// one, in whatever direction. If this image shows the share r of the reference's landmarks and the
// share s of the last frame's, one such motion loses 1 - s, so r - (1 - s) remains.
double NextOverlap(const Map& map, const Sensor& sensor, const Rigid3& cam_from_world,
                   KeyframeId reference, const LastFrame& last);

}  // namespace hullslam
