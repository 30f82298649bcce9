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
#include "hullslam/objects/object_changes.h"

namespace hullslam {

// One observation of an object, with everything that is needed to judge the shape of the object.
// Pixels are undistorted.
struct ObservationResult {
  KeyframeId keyframe;
  double timestamp = 0.0;  // seconds
  Rigid3 cam_from_world;
  std::string label;
  double score = 1.0;
  bool is_cut = false;
  bool is_box = false;
  std::vector<Eigen::Vector2d> hull;     // convex, positive signed area
  std::vector<Eigen::Vector2d> contour;  // closed contour of the largest part
  std::vector<SilhouetteLine> lines;
};

// The agreement of an ellipsoid with its observations (measured by eval/object_metrics.h): means
// over the observations that have a value; absent if no observation has one.
struct ObjectFit {
  std::optional<double> siou = std::nullopt;       // with the hull, 0 to 1
  std::optional<double> siou_mask = std::nullopt;  // with the contour, 0 to 1
  std::optional<double> mtd_m2 = std::nullopt;
  std::optional<double> tangent_px = std::nullopt;
  size_t observations = 0;
  size_t lines = 0;  // two-sided lines, over which mtd_m2 and tangent_px are means
};

struct ObjectResult {
  ObjectId id;
  ObjectState state = ObjectState::kCandidate;
  std::string label;                    // the class with most votes
  std::map<std::string, double> votes;  // sum of scores by class
  Ellipsoid ellipsoid;                  // world frame
  double misfit_px = 0.0;
  std::string name;                             // given by a user; empty if there is none
  bool is_locked = false;                       // by a user
  double known_size = 0.0;                      // ObjectLandmark::known_size
  std::vector<ObservationResult> observations;  // by increasing keyframe id
  ObjectFit fit;

  // The name, if there is one, after two blanks: for the end of a line of a table.
  std::string NameAtEnd() const { return name.empty() ? name : "  " + name; }
};

// The largest angle between the rays from the cameras of the observations to the centre, degrees.
double ParallaxOf(const ObjectResult& object);

// The reliability of the shape, from 0 to 1: the mean SIoU times min(1, parallax / 20 degrees)
// times min(1, observations / 10). 0 if the SIoU is unknown. Masks that were all seen from one side
// agree with many shapes, so the SIoU alone is not enough.
double QualityOf(const ObjectResult& object);

// The report of a run about its objects. It does not refer to the map that it was made from.
struct ObjectResults {
  std::string sequence;  // the folder of the sequence
  PinholeCamera camera;
  size_t candidates = 0;              // objects that are not mapped, with or without a shape
  std::vector<ObjectResult> objects;  // objects with a shape, by increasing id
  // The changes of objects, if the run has added keyframes to a map of earlier sessions.
  std::optional<std::vector<ChangedObject>> changes;
};

// The report of one object of the map, without its fit.
ObjectResult ResultOfObject(const Map& map, ObjectId id, const ObjectLandmark& object);

// Fills in everything except `sequence`, `changes` and the fits.
ObjectResults CollectObjectResults(const Map& map, const PinholeCamera& camera);

}  // namespace hullslam
