// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/report/object_report.h"

#include <utility>

namespace hullslam {
namespace {

ReportedView MakeView(const Map& map, const ObjectObservation& observation) {
  const Keyframe& keyframe = map.keyframes().At(observation.keyframe);
  const Detection& seen = keyframe.frame->detections.at(observation.detection);
  ReportedView view;
  view.keyframe = observation.keyframe;
  view.timestamp = keyframe.frame->timestamp;
  view.cam_from_world = keyframe.cam_from_world;
  view.label = seen.label;
  view.score = seen.score;
  view.is_cut = seen.is_cut;
  view.is_box = seen.is_box;
  view.hull = seen.hull;
  view.contour = seen.contour;
  view.lines = seen.lines;
  return view;
}

ReportedObject MakeObject(const Map& map, ObjectId id, const ObjectLandmark& object) {
  ReportedObject reported;
  reported.id = id;
  reported.state = object.state;
  reported.label = object.Label();
  reported.votes = object.votes;
  reported.ellipsoid = object.ellipsoid;
  reported.misfit_px = object.misfit_px;
  for (const ObjectObservation& observation : object.observations) {
    reported.views.push_back(MakeView(map, observation));
  }
  return reported;
}

}  // namespace

ObjectReport ReportObjects(const Map& map, const PinholeCamera& camera) {
  ObjectReport report;
  report.camera = camera;
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    report.candidates += object.state == ObjectState::kCandidate ? 1 : 0;
    if (object.has_shape && !object.observations.empty()) {
      report.objects.push_back(MakeObject(map, id, object));
    }
  });
  return report;
}

}  // namespace hullslam
