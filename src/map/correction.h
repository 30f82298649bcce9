// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/features/feature_set.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"

namespace hullslam {

struct CorrectionOutcome {
  // False if the map was corrected again since the snapshot of the correction. The map is then
  // unchanged.
  bool is_applied = false;
  // Objects that others were merged into. Each is a candidate now and has to be refined before it
  // constrains anything again. By increasing id.
  std::vector<ObjectId> merged_objects;
};

// Applies a correction to the map. For a keyframe of the correction C = corrected^-1 * snapshot
// maps the old world to the new one. A keyframe that is not in the correction, because it was made
// or culled at another time, takes the C of its nearest ancestor in the spanning tree that is in
// the correction; without such an ancestor it does not move. A culled keyframe is moved too, so
// that frames tracked relative to it follow. C is applied to the keyframe's current pose, so that
// the changes of local bundle adjustment since the snapshot survive. Landmarks and objects move
// with their reference keyframes, but a landmark with a position in the correction moves there.
// Half axes and misfit samples of objects take the scale of C. Where the corrected pose equals the
// snapshot's pose, to the last bit and with scale 1, nothing moves.
//
// Then landmarks and objects are merged, covisibility is counted again for the keyframes whose
// observations were merged, and the loop edge is added. If its ends belong to different islands,
// these become one (JoinIslands). If a landmark, an object or a keyframe that a merge or the loop
// edge names was replaced or culled since the snapshot, its replacement or nearest ancestor is
// used. Merges of erased landmarks or objects and positions of missing landmarks are ignored.
// Scales must be finite and positive, else CheckError is thrown and the map is unchanged.
CorrectionOutcome ApplyCorrection(Map& map, const MapCorrection& correction,
                                  const ScaleLevels& levels);

// The correction after which all lengths in the map are `factor` times as large.
MapCorrection ScalingOf(const Map& map, double factor);

}  // namespace hullslam
