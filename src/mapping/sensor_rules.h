// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <limits>
#include <optional>

#include "hullslam/frame/sensor.h"
#include "hullslam/mapping/mapping_options.h"

namespace hullslam {

// The rules of mapping that depend on the sensor.

// The rules by which landmarks and keyframes are removed.
struct CullingRules {
  static constexpr size_t kMaxOtherObservers = 4;  // the same for all sensors

  // After its trial a landmark is removed if its observation weight is not larger than this. An
  // observation with depth weighs 2, one without weighs 1.
  int max_weak_weight = 0;
  // A keyframe is not needed for a landmark that this many other keyframes see too.
  size_t other_observers = 0;
  // Whether keyframes between which the landmark has no measurable parallax count as one.
  bool observers_need_parallax = false;
  // A keyframe with fewer landmarks is not redundant.
  int min_landmarks = 20;
  // With fewer close landmarks, the far ones are judged too: the pose of the keyframe depends on
  // them (the bound of Mur-Artal and Tardos 2017 for a frame that lacks close points).
  int min_close_landmarks = 100;
  // Whether only close landmarks count. Then a keyframe without any is not redundant.
  bool only_close_landmarks = false;
  // A keyframe stays if the one before and the one after it would share fewer landmarks than this
  // without it, and fewer than each of them shares with it.
  int min_shared = 0;
  // Whether a keyframe stays if an object needs its view.
  bool keeps_object_views = true;

  static CullingRules ForSensor(SensorKind kind, MappingRule rule = MappingRule::kHullslam);
};

// The rules by which landmarks are made from depth and from pairs of keyframes.
struct LandmarkRules {
  // Keypoints beyond the close ones become no landmarks once the keyframe has `enough_in_image`,
  // and the cell of the image in which they are, of 4 x 3, has `enough_in_cell`. Nearer ones come
  // first.
  size_t enough_in_image = 100;
  size_t enough_in_cell = 0;
  size_t neighbours = 0;  // number of best covisible keyframes that are paired with a new one
  // Shortest baseline of a pair, m. Absent: `min_baseline_share` of the median depth of the
  // landmarks.
  std::optional<double> min_baseline;
  double min_baseline_share = 0.0;
  // Whether the landmarks beside a pair of keypoints decide if its parallax is large enough.
  // Otherwise the parallax of the pair itself decides, and its depth is used if it is too small.
  bool nearby_landmarks_decide = false;

  static LandmarkRules ForSensor(const Sensor& sensor, MappingRule rule = MappingRule::kHullslam);
};

}  // namespace hullslam
