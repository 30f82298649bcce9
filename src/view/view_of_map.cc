// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/view_of_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "eval/object_metrics.h"
#include "map/located_landmarks.h"
#include "objects/object_view.h"
#include "objects/validity.h"

namespace hullslam {
namespace {

// Edges with fewer shared landmarks are not in the essential graph of ORB-SLAM2 (Mur-Artal and
// Tardos 2017), and they would cover the picture.
constexpr int kLeastShared = 100;

void AddLandmarks(const Map& map, const LocatedLandmarks& located, ViewLandmarks& landmarks) {
  landmarks = {.positions = {}, .colours = {}, .created = {}, .total = located.positions.size()};
  for (size_t i = 0; i < located.positions.size(); ++i) {
    landmarks.positions.push_back(located.positions[i].cast<float>());
    landmarks.created.push_back(CreationOf(map, map.landmarks().At(located.ids[i])));
  }
}

void AddKeyframes(const Map& map, ViewModel& model) {
  model.keyframes = {};
  model.edges = {};
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    model.keyframes.ids.push_back(id.value);
    model.keyframes.poses.push_back({keyframe.frame->timestamp, Inverse(keyframe.cam_from_world)});
    for (const Covisible& other : keyframe.covisible) {
      if (id < other.keyframe && other.shared >= kLeastShared) {
        model.edges.covisibility.push_back({id.value, other.keyframe.value});
      }
    }
    for (const KeyframeId other : keyframe.loops) {
      if (id < other) {
        model.edges.loops.push_back({id.value, other.value});
      }
    }
  });
}

// The objection that the mapper would have now.
std::string ReasonOf(const Map& map, const ObjectLandmark& object, const Sensor& sensor,
                     const ObjectOptions& options) {
  if (object.observations.size() < static_cast<size_t>(options.start.min_views)) {
    return fmt::format("{} keyframes, expected at least {}", object.observations.size(),
                       options.start.min_views);
  }
  const std::vector<ObjectView> views = CollectViews(map, object);
  const auto objection = object.has_shape
                             ? FindObjection(object.ellipsoid, sensor, views, options.validity)
                             : std::nullopt;
  return objection ? ToString(objection->reason) + ", " + objection->detail : std::string();
}

// The pixel of the keyframe that the landmark was last described by, if it still observes it.
const Observation& ShowingObservation(const Landmark& landmark) {
  const auto found =
      std::find_if(landmark.observations.begin(), landmark.observations.end(),
                   [&](const Observation& seen) { return seen.keyframe == landmark.reference; });
  return found != landmark.observations.end() ? *found : landmark.observations.front();
}

}  // namespace

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

ViewModel ViewOfMap(const Map& map, const Sensor& sensor, const ObjectOptions& options) {
  ViewModel model;
  model.camera = sensor.camera;
  model.is_metric = !sensor.IsMonocular();
  ObjectReport report = ReportObjects(map, sensor.camera);
  MeasureObjects(report);
  for (ReportedObject& object : report.objects) {
    model.objects.push_back({std::move(object), {}, {}});
  }
  AddMap(map, sensor, options, model);
  model.trajectory = model.keyframes.poses;
  std::sort(model.trajectory.begin(), model.trajectory.end(),
            [](const StampedPose& a, const StampedPose& b) { return a.timestamp < b.timestamp; });
  return model;
}

std::vector<KeyframePixels> FindLandmarkPixels(const Map& map, const Sensor& sensor) {
  std::map<KeyframeId, KeyframePixels> by_keyframe;
  const LocatedLandmarks located = LocateLandmarks(map, sensor);
  for (size_t i = 0; i < located.ids.size(); ++i) {
    const Observation& seen = ShowingObservation(map.landmarks().At(located.ids[i]));
    const Frame& frame = *map.keyframes().At(seen.keyframe).frame;
    KeyframePixels& pixels = by_keyframe[seen.keyframe];
    pixels.timestamp = frame.timestamp;
    const Eigen::Vector2d undistorted =
        frame.features.keypoints[seen.keypoint].undistorted.cast<double>();
    pixels.pixels.push_back({i, sensor.camera.Distort(undistorted)});
  }
  std::vector<KeyframePixels> list;
  for (auto& [keyframe, pixels] : by_keyframe) {
    list.push_back(std::move(pixels));
  }
  std::sort(list.begin(), list.end(), [](const KeyframePixels& a, const KeyframePixels& b) {
    return a.timestamp < b.timestamp;
  });
  return list;
}

}  // namespace hullslam
