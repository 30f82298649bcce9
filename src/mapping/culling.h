// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/mapping/mapping_options.h"
#include "map/contradictions.h"
#include "util/id_set.h"

namespace hullslam {

// Removes landmarks of things that have moved away: those that the depth images of the keyframe
// `current` and of two earlier ones contradict. A keyframe contradicts a landmark that it should
// see but does not observe, if every depth around the landmark's projection was measured behind the
// landmark. Something nearer hides the landmark and is no contradiction. If the landmark is
// observed again, or if a depth is that of the landmark, the count begins again. So it does not
// matter how many keyframes have observed it before. Checks the landmarks of all keyframes that are
// covisible with `current`. Returns how many were removed: none without depth. To be called once
// per keyframe.
size_t EraseContradictedLandmarks(Map& map, KeyframeId current, const Sensor& sensor,
                                  Contradictions<LandmarkId>& contradictions);

// Removes `recent` landmarks from the map if they were found in less than a quarter of the frames
// in which they should have been visible, or if their observation weight is still too small two
// keyframes after they were made (Mur-Artal and Tardos 2015, section VI.B). Landmarks that no
// longer exist or that are three keyframes old leave the list. Landmarks of islands other than that
// of `current` leave it too, because the camera was lost before it could see them again.
void CullRecentLandmarks(Map& map, KeyframeId current, const Sensor& sensor,
                         std::vector<LandmarkId>& recent);

// Counts for landmarks the visits in which the camera found them, and those in which it should have
// seen them but did not. Visits to a landmark are separate if the camera was elsewhere for a
// minute, so a thing that hides it for an hour, or an hour in the dark, is one visit.
class LandmarkVisits {
 public:
  struct Counts {
    double last = -1e9;  // s, the end of the last message with the landmark
    int found = 0;
    int missed = 0;  // since it was found
  };

  // Adds the sightings since the last call, up to a time (s).
  void Add(const Map& map, const std::vector<Sighting>& sightings, double time);
  // Zeros for a landmark that was never counted.
  Counts Of(LandmarkId landmark) const {
    const Counts* const counts = counts_.Find(landmark);
    return counts != nullptr ? *counts : Counts();
  }

 private:
  IdMap<LandmarkId, Counts> counts_;
  double begin_ = 0.0;  // of the next sightings, s
};

// Removes landmarks that the keyframe `current` should show if they were missed in eight visits for
// each one in which they were found before (fifty at most), and eight more. Those that were missed
// in three visits also go if two others were found since then at the same place and scale: a place
// looks different by day and by lamp, but keeps no third appearance. Returns how many were removed.
size_t EraseForgottenLandmarks(Map& map, KeyframeId current, const Sensor& sensor,
                               const LandmarkVisits& visits);

// The landmarks of a map of an earlier session that CullRecentLandmarks has to check, by increasing
// id: those that were not three keyframes old at its end.
std::vector<LandmarkId> FindRecentLandmarks(const Map& map);

// Removes redundant keyframes among those covisible with `current`. A keyframe is redundant if more
// than nine tenths of its close landmarks are each seen by at least four other keyframes, at most
// one level coarser than by this keyframe (section VI.E). For a monocular sensor,
// keyframes between which the landmark has no measurable parallax count as one. If the keyframe has
// fewer than 100 close landmarks, the same must hold for all of its landmarks. With fewer than 20
// landmarks it is not redundant. A keyframe also stays if an object (mapped or candidate) needs its
// view: because fewer than `min_object_views` views would be left, or because no other keyframe
// sees the object from a similar direction. With the rule of ORB-SLAM2 (CullingRules) fewer
// conditions hold. Returns how many were removed.
int CullKeyframes(Map& map, KeyframeId current, const Sensor& sensor, size_t min_object_views,
                  MappingRule rule = MappingRule::kHullslam);

// Removes up to two keyframes if the map has more than `most` (mapping.max_keyframes): those with
// the largest share of landmarks that enough others see too (as for CullKeyframes). The root, the
// newest 20, and those with a share of less than a half stay, even if the bound is exceeded. So do
// keyframes whose neighbours in time have little in common without them, and those that an object
// needs to have `min_object_views`. To be called once per keyframe. Returns how many were removed.
int CullOverBound(Map& map, KeyframeId current, const Sensor& sensor, size_t min_object_views,
                  size_t most);

// Compacts keyframes that are old, so that later steps hardly need all of their keypoints
// (map/compaction.h). These are the keyframes that are more than 20 keyframes older than `current`
// and are covisible neither with `current` nor with a keyframe that is covisible with it. `full`
// are the keyframes that may have to be compacted, by increasing id. Those that are compacted, or
// culled, are removed from it.
//
// Keypoints that show no landmark are only kept so that they can be triangulated with new
// keyframes. This was already tried with all keyframes near an old one. Place recognition and
// relocalisation need only the keypoints that show landmarks.
void CompactOldKeyframes(Map& map, KeyframeId current, std::vector<KeyframeId>& full);

}  // namespace hullslam
