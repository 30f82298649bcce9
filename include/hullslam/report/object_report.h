// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/line2.h"
#include "hullslam/map/map.h"

namespace hullslam {

// One view of an object, with all that its shape can be judged by; undistorted pixels.
struct ReportedView {
  KeyframeId keyframe;
  double timestamp = 0.0;  // seconds
  Rigid3 cam_from_world;
  std::string label;
  double score = 1.0;
  bool is_cut = false;
  bool is_box = false;
  std::vector<Eigen::Vector2d> hull;     // convex, positive signed area
  std::vector<Eigen::Vector2d> contour;  // closed; of the largest part
  std::vector<SilhouetteLine> lines;
};

// How well an ellipsoid agrees with its views (eval/object_metrics.h measures it): means over the
// views that have a value; absent where none has.
struct ObjectFit {
  std::optional<double> siou = std::nullopt;       // with the hull, 0 to 1
  std::optional<double> siou_mask = std::nullopt;  // with the contour, 0 to 1
  std::optional<double> mtd_m2 = std::nullopt;
  std::optional<double> tangent_px = std::nullopt;
  size_t observations = 0;
  size_t lines = 0;  // two-sided ones, of which the last two means are
};

struct ReportedObject {
  ObjectId id;
  ObjectState state = ObjectState::kCandidate;
  std::string label;                    // the class with most votes
  std::map<std::string, double> votes;  // sum of scores by class
  Ellipsoid ellipsoid;                  // world frame
  double misfit_px = 0.0;
  std::vector<ReportedView> views;  // by increasing keyframe id
  ObjectFit fit;
};

// What a run tells about its objects, free of the map it was taken from.
struct ObjectReport {
  std::string sequence;  // its folder
  PinholeCamera camera;
  size_t candidates = 0;                // objects that are not mapped, with a shape or without
  std::vector<ReportedObject> objects;  // those with a shape, by increasing id
};

// All but `sequence` and the fits.
ObjectReport ReportObjects(const Map& map, const PinholeCamera& camera);

}  // namespace hullslam
