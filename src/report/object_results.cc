// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/object_results.h"

#include <algorithm>
#include <utility>

#include "objects/resolved_observation.h"

namespace hullslam {
namespace {

ObservationResult ResultOfObservation(const Map& map, const ObjectObservation& observed) {
  const Keyframe& keyframe = map.keyframes().At(observed.keyframe);
  const Detection& seen = keyframe.frame->detections.at(observed.detection);
  ObservationResult observation;
  observation.keyframe = observed.keyframe;
  observation.timestamp = keyframe.frame->timestamp;
  observation.cam_from_world = keyframe.cam_from_world;
  observation.label = seen.label;
  observation.score = seen.score;
  observation.is_cut = seen.is_cut;
  observation.is_box = seen.is_box;
  observation.hull = seen.hull;
  observation.contour = seen.contour.Unpack();
  observation.lines = seen.lines;
  return observation;
}

}  // namespace

ObjectResult ResultOfObject(const Map& map, ObjectId id, const ObjectLandmark& object) {
  ObjectResult reported;
  reported.id = id;
  reported.state = object.state;
  reported.label = object.Label();
  reported.votes = object.votes;
  reported.ellipsoid = object.ellipsoid;
  reported.misfit_px = object.misfit_px;
  reported.name = object.name;
  reported.is_locked = object.is_locked;
  reported.known_size = object.known_size;
  for (const ObjectObservation& observation : object.observations) {
    reported.observations.push_back(ResultOfObservation(map, observation));
  }
  return reported;
}

double ParallaxOf(const ObjectResult& object) {
  std::vector<ResolvedObservation> observations;
  observations.reserve(object.observations.size());
  for (const ObservationResult& observation : object.observations) {
    observations.push_back(
        {.keyframe = observation.keyframe, .cam_from_world = observation.cam_from_world});
  }
  return Parallax(observations, object.ellipsoid.world_from_object.translation);
}

double QualityOf(const ObjectResult& object) {
  constexpr double kFullParallax = 20.0;  // degrees
  constexpr double kFullObservations = 10.0;
  return object.fit.siou.value_or(0.0) * std::min(1.0, ParallaxOf(object) / kFullParallax) *
         std::min(1.0, static_cast<double>(object.observations.size()) / kFullObservations);
}

ObjectResults CollectObjectResults(const Map& map, const PinholeCamera& camera) {
  ObjectResults report;
  report.camera = camera;
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    report.candidates += object.state == ObjectState::kCandidate ? 1 : 0;
    if (object.has_shape && !object.observations.empty()) {
      report.objects.push_back(ResultOfObject(map, id, object));
    }
  });
  return report;
}

}  // namespace hullslam
