// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/view_of_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "eval/object_metrics.h"
#include "map/located_landmarks.h"
#include "objects/resolved_observation.h"
#include "objects/validity.h"
#include "scene/make_scene.h"

namespace hullslam {
namespace {

void AddLandmarks(const Map& map, const LocatedLandmarks& located, ViewLandmarks& landmarks) {
  landmarks = {.positions = {}, .colours = {}, .created = {}, .total = located.positions.size()};
  for (size_t i = 0; i < located.positions.size(); ++i) {
    landmarks.positions.push_back(located.positions[i].cast<float>());
    landmarks.created.push_back(CreationOf(map, map.landmarks().At(located.ids[i])));
  }
}

void AddKeyframes(const Map& map, ViewModel& model) {
  model.keyframes = {};
  model.edges = FindEdges(map);
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    model.keyframes.ids.push_back(id.value);
    model.keyframes.poses.push_back({keyframe.frame->timestamp, Inverse(keyframe.cam_from_world)});
  });
}

// The objection that the mapper would have now.
std::string ReasonOf(const Map& map, const ObjectLandmark& object, const Sensor& sensor,
                     const ObjectOptions& options) {
  if (object.observations.size() < static_cast<size_t>(options.start.min_views)) {
    return fmt::format("{} keyframes, expected at least {}", object.observations.size(),
                       options.start.min_views);
  }
  const std::vector<ResolvedObservation> views = ResolveObservations(map, object);
  const auto objection = object.has_shape
                             ? FindObjection(object.ellipsoid, sensor, views, options.validity)
                             : std::nullopt;
  return objection ? ToString(objection->reason) + ", " + objection->detail : std::string();
}

}  // namespace

ViewEdges FindEdges(const Map& map, size_t most_covisible, std::optional<IslandId> island) {
  constexpr int kLeastShared = 100;
  std::vector<std::tuple<int, uint32_t, uint32_t>> covisible;  // the most shared landmarks first
  ViewEdges edges;
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    if (island && keyframe.island != *island) {
      return;
    }
    for (const Covisible& other : keyframe.covisible) {
      if (id < other.keyframe && other.shared >= kLeastShared) {
        covisible.emplace_back(-other.shared, id.value, other.keyframe.value);
      }
    }
    for (const KeyframeId other : keyframe.loops) {
      if (id < other) {
        edges.loops.push_back({id.value, other.value});
      }
    }
  });
  if (covisible.size() > most_covisible) {
    std::nth_element(covisible.begin(), covisible.begin() + static_cast<ptrdiff_t>(most_covisible),
                     covisible.end());
    covisible.resize(most_covisible);
  }
  for (const auto& [shared, a, b] : covisible) {
    edges.covisibility.push_back({a, b});
  }
  std::sort(edges.covisibility.begin(), edges.covisibility.end());
  return edges;
}

double CreationOf(const Map& map, const Landmark& landmark) {
  const Keyframe* keyframe = map.keyframes().Find(landmark.created_by);
  if (keyframe == nullptr) {
    keyframe = &map.keyframes().At(landmark.observations.front().keyframe);
  }
  return keyframe->frame->timestamp;
}

void AddMap(const Map& map, const Sensor& sensor, const ObjectOptions& options, ViewModel& model) {
  AddLandmarks(map, LocateLandmarks(map, sensor), model.landmarks);
  AddKeyframes(map, model);
  for (ViewObject& shown : model.objects) {
    const ObjectLandmark* object = map.objects().Find(shown.object.id);
    if (object != nullptr && object->state != ObjectState::kMapped) {
      shown.reason = ReasonOf(map, *object, sensor, options);
    }
  }
}

std::map<ObjectId, SceneObject> BodiesOf(const Map& map, const PinholeCamera& camera,
                                         const std::optional<Trajectory>& groundtruth) {
  std::map<ObjectId, SceneObject> bodies;
  for (SceneObject& object :
       MakeScene(map, CollectObjectResults(map, camera), groundtruth).objects) {
    const ObjectId id = object.id;
    bodies[id] = std::move(object);
  }
  return bodies;
}

ViewModel ViewOfMap(const Map& map, const Sensor& sensor, const ObjectOptions& options) {
  ViewModel model;
  model.camera = sensor.camera;
  model.is_metric = !sensor.IsMonocular();
  ObjectResults report = CollectObjectResults(map, sensor.camera);
  MeasureObjects(report);
  for (ObjectResult& object : report.objects) {
    model.objects.push_back({std::move(object), {}, {}});
  }
  AddMap(map, sensor, options, model);
  model.trajectory = model.keyframes.poses;
  std::sort(model.trajectory.begin(), model.trajectory.end(),
            [](const StampedPose& a, const StampedPose& b) { return a.timestamp < b.timestamp; });
  return model;
}

}  // namespace hullslam
