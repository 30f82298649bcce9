// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "objects/made_objects.h"
#include "support/ring_world.h"

namespace hullslam {

// A thing that the ring's cameras see in their first turn, in their last one, or in both.
struct RingThing {
  MadeObject object;
  bool is_at_first = true;
  bool is_at_last = true;
};

// A thing of about 30 cm, 2.2 m in front of the camera after so many turns and by `aside` (m) to
// its right.
inline MadeObject ThingAt(const std::string& label, double turns, double aside) {
  MadeObject thing = MakeObject(label, Eigen::Vector3d::Zero(), {0.15, 0.12, 0.18});
  thing.ellipsoid.world_from_object = Inverse(RingWorld::CamFromWorld(turns)) *
                                      Rigid3(Eigen::Quaterniond::Identity(), {aside, 0.0, 2.2});
  return thing;
}

// Three things at the place where the shared map ends. The camera was there before, after 5 of 24
// keyframes.
inline std::vector<RingThing> ThreeThings() {
  return {{ThingAt("cup", 5.0 / 24.0, -0.7)},
          {ThingAt("book", 5.0 / 24.0, 0.0)},
          {ThingAt("bottle", 5.0 / 24.0, 0.5)}};
}

// A ring map in which the things are mapped objects, one for each of the two turns in which they
// are seen. Those of the last turn have drifted with their keyframes.
inline RingMap MakeRingMap(const RingWorld& world, const RingMapOptions& options,
                           const std::vector<RingThing>& things) {
  const uint32_t first_frame_of_last = 3 * options.keyframes_per_turn;
  const auto visible = [&](uint32_t frame, const Rigid3& pose) {
    std::vector<size_t> indices;
    for (size_t i = 0; i < things.size(); ++i) {
      const bool is_there =
          frame < first_frame_of_last ? things[i].is_at_first : things[i].is_at_last;
      const auto ellipse =
          ProjectEllipsoid(world.sensor().camera.Matrix(), pose, things[i].object.ellipsoid);
      if (is_there && ellipse && world.sensor().bounds.Contains(ellipse->Bounds().min()) &&
          world.sensor().bounds.Contains(ellipse->Bounds().max())) {
        indices.push_back(i);
      }
    }
    return indices;
  };
  RingMap made = MakeRingMap(world, options, [&](Frame& frame, const Rigid3& pose) {
    for (const size_t i : visible(frame.id.value, pose)) {
      frame.detections.push_back(Detect(things[i].object, world.sensor(), pose));
    }
  });
  for (const bool is_last : {false, true}) {
    for (size_t i = 0; i < things.size(); ++i) {
      ObjectId id;
      for (uint32_t k = 0; k < options.keyframes; ++k) {
        const std::vector<size_t> seen = visible(3 * k, made.true_cam_from_world[k]);
        const auto seen_at = std::find(seen.begin(), seen.end(), i);
        if ((3 * k >= first_frame_of_last) != is_last || seen_at == seen.end()) {
          continue;
        }
        if (!id.IsValid()) {
          id = made.map.AddObject();
          ObjectLandmark& object = made.map.MutableObject(id);
          object.state = ObjectState::kMapped;
          object.has_shape = true;
          object.ellipsoid = made.drifted_from_world[k] * things[i].object.ellipsoid;
          object.start = object.ellipsoid;
        }
        made.map.AddObservation(id, KeyframeId(k), static_cast<uint32_t>(seen_at - seen.begin()));
      }
    }
  }
  return made;
}

}  // namespace hullslam
