// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/sensor_rules.h"

namespace hullslam {

CullingRules CullingRules::ForSensor(SensorKind kind, MappingRule rule) {
  if (rule == MappingRule::kOrbSlam2) {
    // Mur-Artal and Tardos 2015, section VI.E; with depth only close landmarks count (the function
    // KeyFrameCulling of the released LocalMapping.cc).
    return {.max_weak_weight = kind == SensorKind::kMonocular ? 2 : 3,
            .other_observers = 3,
            .observers_need_parallax = false,
            .min_landmarks = 1,
            .only_close_landmarks = kind != SensorKind::kMonocular,
            .keeps_object_views = false};
  }
  if (kind == SensorKind::kMonocular) {
    // Only landmarks that are seen from three viewpoints carry the scale from one pair of keyframes
    // to the next. So the two keyframes that a landmark is made of are not enough, and a keyframe
    // is needed until four others see its landmarks from different viewpoints.
    return {.max_weak_weight = 2, .other_observers = 4, .observers_need_parallax = true};
  }
  // Depth gives every keyframe the scale. One observation with depth and one without are too few.
  // With three other observers, too few keyframes remain where the camera passes a plain wall:
  // those that are left share so few landmarks that the map bends there (docs/results.md, icl3).
  // A keyframe whose landmarks others see may still join two sides. Mur-Artal and Tardos 2015
  // (section III.D) call two keyframes strongly connected from 100 shared landmarks on.
  return {.max_weak_weight = 3,
          .other_observers = 4,
          .observers_need_parallax = false,
          .min_shared = 100};
}

LandmarkRules LandmarkRules::ForSensor(const Sensor& sensor, MappingRule rule) {
  if (sensor.IsMonocular() && rule == MappingRule::kOrbSlam2) {
    // Mur-Artal and Tardos 2015, section VI.C; the baseline is that of the function
    // CreateNewMapPoints of the released LocalMapping.cc.
    return {.neighbours = 20,
            .min_baseline = std::nullopt,
            .min_baseline_share = 0.01,
            .nearby_landmarks_decide = false};
  }
  if (sensor.IsMonocular()) {
    // All landmarks are made from pairs, so more pairs are tried. There are no metres, so the
    // shortest baseline depends on how far away the landmarks are. Without depth to fall back on, a
    // pair whose parallax is only noise gives a landmark that is too near.
    return {.neighbours = 20,
            .min_baseline = std::nullopt,
            .min_baseline_share = 0.005,
            .nearby_landmarks_decide = true};
  }
  // Keyframes have made landmarks of their depth already. Depth is more precise than triangulation
  // over a baseline that is shorter than that of the virtual stereo pair.
  //
  // Far landmarks are less precise, but where the camera looks through a door they are all that the
  // next image shows. So each cell of the image gets its share of the hundred landmarks that
  // ORB-SLAM2 wants in the whole image (the function CreateNewKeyFrame of the released
  // Tracking.cc).
  constexpr size_t kShareOfHundred = 9;  // 12 cells
  LandmarkRules rules{.enough_in_cell = kShareOfHundred,
                      .neighbours = 10,
                      .min_baseline = sensor.baseline(),
                      .min_baseline_share = 0.0,
                      .nearby_landmarks_decide = false};
  if (rule == MappingRule::kOrbSlam2) {
    rules.enough_in_cell = 0;
  }
  return rules;
}

}  // namespace hullslam
