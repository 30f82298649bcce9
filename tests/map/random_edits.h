// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "hullslam/map/map.h"
#include "map/keyframe_graph.h"
#include "map/made_map.h"
#include "support/random_geometry.h"

namespace hullslam {

// Changes a map at random by all of its public functions except those for derived data.
class RandomEdits {
 public:
  explicit RandomEdits(uint32_t seed) : random_(seed) {}

  void Edit(Map& map) {
    const uint32_t kind = random_.Index(17);
    if (map.keyframes().size() < 3 || kind == 0) {
      Grow(map);
    } else if (kind <= 3) {
      AddLandmark(map);
    } else if (kind <= 5) {
      map.AddObservation(AnyLandmark(map), AnyKeyframe(map), random_.Index(kKeypoints));
    } else if (kind == 6) {
      RemoveObservation(map);
    } else if (kind == 7) {
      Replace(map);
    } else if (kind == 8) {
      Cull(map);
    } else if (kind == 9) {
      UpdateCovisibility(map, AnyKeyframe(map));
    } else if (kind == 10) {
      map.SetPose(AnyKeyframe(map), random_.Pose(1.0, 2.0));
    } else if (kind == 11) {
      Move(map);
    } else if (kind == 12) {
      JoinLoop(map);
    } else {
      EditObjects(map);
    }
  }

 private:
  static constexpr uint32_t kKeypoints = 40;

  // A new keyframe shares landmarks with earlier ones, as in mapping, or shares none.
  void Grow(Map& map) {
    const KeyframeId id = AddKeyframe(map, kKeypoints, kKeypoints / 3, random_.Pose(1.0, 2.0));
    for (uint32_t i = 0; i < random_.Index(30) && !map.landmarks().empty(); ++i) {
      map.AddObservation(AnyLandmark(map), id, random_.Index(kKeypoints));
    }
    UpdateCovisibility(map, id);
    if (id != KeyframeId(0) && !map.keyframes().At(id).parent.IsValid()) {
      SetParent(map, id, KeyframeId(0));
    }
    AddLandmark(map);
  }

  void AddLandmark(Map& map) {
    const LandmarkId landmark = map.AddLandmark(random_.Vector(3.0), AnyKeyframe(map));
    for (uint32_t i = 0; i < 1 + random_.Index(5); ++i) {
      map.AddObservation(landmark, AnyKeyframe(map), random_.Index(kKeypoints));
    }
  }

  void RemoveObservation(Map& map) {
    const LandmarkId id = AnyLandmark(map);
    const std::vector<Observation>& observations = map.landmarks().At(id).observations;
    if (!observations.empty()) {
      map.RemoveObservation(id, observations[random_.Index(observations.size())].keyframe);
    }
  }

  void Replace(Map& map) {
    const LandmarkId a = AnyLandmark(map);
    const LandmarkId b = AnyLandmark(map);
    if (a != b) {
      map.ReplaceLandmark(a, b);
    }
  }

  void Cull(Map& map) {
    const KeyframeId id = AnyKeyframe(map);
    if (map.keyframes().At(id).parent.IsValid()) {
      map.CullKeyframe(id);
    }
  }

  void Move(Map& map) {
    const LandmarkId id = AnyLandmark(map);
    map.SetPosition(id, random_.Vector(3.0));
    map.CountSightings(id, 2, 1);
    if (random_.Index(3) == 0) {
      map.EraseLandmark(id);
    }
  }

  void JoinLoop(Map& map) {
    const KeyframeId a = AnyKeyframe(map);
    const KeyframeId b = AnyKeyframe(map);
    if (a != b) {
      map.AddLoop(a, b);
    }
  }

  void EditObjects(Map& map) {
    const ObjectId object = AnyObject(map);
    const ObjectId other = AnyObject(map);
    const uint32_t kind = random_.Index(8);
    if (kind == 0) {
      map.AddObject();
    } else if (kind <= 4) {
      map.AddObservation(object, AnyKeyframe(map), random_.Index(kDetections));
    } else if (kind == 5 && !map.objects().At(object).observations.empty()) {
      const std::vector<ObjectObservation>& seen = map.objects().At(object).observations;
      map.RemoveObservation(object, seen[random_.Index(seen.size())].keyframe);
    } else if (kind == 6 && object != other) {
      map.ReplaceObject(object, other);
    } else if (kind == 7 && random_.Index(3) == 0) {
      map.EraseObject(object);
    }
  }

  ObjectId AnyObject(Map& map) {
    if (map.objects().empty()) {
      return map.AddObject();
    }
    std::vector<ObjectId> all;
    map.objects().ForEach([&](ObjectId id, const ObjectLandmark&) { all.push_back(id); });
    return all[random_.Index(all.size())];
  }

  // A random one of the map; if there is none, one is made.
  LandmarkId AnyLandmark(Map& map) {
    if (map.landmarks().empty()) {
      return map.AddLandmark(random_.Vector(3.0), AnyKeyframe(map));
    }
    std::vector<LandmarkId> all;
    map.landmarks().ForEach([&](LandmarkId id, const Landmark&) { all.push_back(id); });
    return all[random_.Index(all.size())];
  }
  KeyframeId AnyKeyframe(const Map& map) {
    std::vector<KeyframeId> all;
    map.keyframes().ForEach([&](KeyframeId id, const Keyframe&) { all.push_back(id); });
    return all[random_.Index(all.size())];
  }

  RandomGeometry random_;
};

}  // namespace hullslam
