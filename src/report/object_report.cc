// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/object_report.h"

#include <algorithm>
#include <utility>

#include "objects/object_view.h"

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
  view.contour = seen.contour.Unpack();
  view.lines = seen.lines;
  return view;
}

}  // namespace

ReportedObject ReportObject(const Map& map, ObjectId id, const ObjectLandmark& object) {
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

double ParallaxOf(const ReportedObject& object) {
  std::vector<ObjectView> views;
  views.reserve(object.views.size());
  for (const ReportedView& view : object.views) {
    views.push_back({.keyframe = view.keyframe, .cam_from_world = view.cam_from_world});
  }
  return Parallax(views, object.ellipsoid.world_from_object.translation);
}

double QualityOf(const ReportedObject& object) {
  constexpr double kFullParallax = 20.0;  // degrees
  constexpr double kFullViews = 10.0;
  return object.fit.siou.value_or(0.0) * std::min(1.0, ParallaxOf(object) / kFullParallax) *
         std::min(1.0, static_cast<double>(object.views.size()) / kFullViews);
}

ObjectReport ReportObjects(const Map& map, const PinholeCamera& camera) {
  ObjectReport report;
  report.camera = camera;
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    report.candidates += object.state == ObjectState::kCandidate ? 1 : 0;
    if (object.has_shape && !object.observations.empty()) {
      report.objects.push_back(ReportObject(map, id, object));
    }
  });
  return report;
}

}  // namespace hullslam
