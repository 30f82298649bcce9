// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hullslam/geometry/rigid3.h"
#include "hullslam/geometry/sim3.h"
#include "hullslam/objects/object_changes.h"
#include "report/object_results.h"

namespace hullslam {

// The change of an object between two visits of a synthetic scene.
enum class TrueObjectStatus { kUnchanged, kMoved, kNew };

// A true object of a synthetic sequence (docs/synthetic.md).
struct TrueObject {
  uint32_t id = 0;  // the same in all visits of a scene
  std::string label;
  std::string shape;      // ellipsoid, box, cylinder, superquadric or compound
  bool is_round = false;  // about its z axis
  bool is_dynamic = false;
  Rigid3 world_from_object;  // at the start of the sequence if it moves
  Eigen::Vector3d half_extents = Eigen::Vector3d::Ones();  // m, tight, along the axes of the object
  std::optional<uint32_t> masks;           // of the sequence that show it; absent in older files
  std::optional<TrueObjectStatus> status;  // only in a rearranged scene
  std::optional<Rigid3> former_world_from_object;  // pose before; only of a moved object

  // Mean of the three full extents, m. Relative errors are divided by this.
  double Size() const { return 2.0 * half_extents.mean(); }
};

// The true objects of a synthetic sequence, and those that a rearrangement of the scene took away.
struct TrueScene {
  bool is_rearranged = false;
  std::vector<TrueObject> objects;
  std::vector<TrueObject> gone;  // with their former poses; empty unless the scene was rearranged
};

// A mapped object compared with the true object that it represents.
struct ObjectError {
  ObjectId object;
  size_t truth = 0;               // index of the true object
  double center_m = 0.0;          // distance of the centres
  double center_share = 0.0;      // center_m divided by the Size() of the true object
  Eigen::Vector3d axis_ratios;    // mapped / true half axes, both sorted by length, longest first
  Eigen::Vector3d extent_ratios;  // mapped / true half extents along the axes of the true object
  std::optional<double> siou;     // SIoU of the mapped object, from its ObjectFit
};

struct GroundtruthComparison {
  std::vector<ObjectError> errors;      // grouped by true object, the nearest first
  std::vector<ObjectId> without_truth;  // mapped objects that represent no true object
  std::vector<size_t> times_mapped;     // one count per true object
};

// Assigns to each mapped object of the report the true object with the nearest centre, where
// distances are divided by the Size() of the true object and must be at most one half. Classes do
// not matter. Moving true objects are never assigned. The true objects are in metres;
// `truth_from_map` has the scale 1 if the map is in metres too.
GroundtruthComparison CompareWithTruth(std::span<const TrueObject> truths,
                                       const ObjectResults& report, const Sim3& truth_from_map);

// How many of the true objects that should be mapped were mapped, and how often.
struct TruthCounts {
  size_t visible = 0;  // seen often enough and not moving
  size_t once = 0;     // visible objects that were mapped as one object
  size_t more = 0;     // visible objects that were mapped as several objects
  size_t never = 0;
};

// Counts the true objects with at least `min_sightings` sightings. Without counts of sightings all
// objects count as visible.
TruthCounts CountMapped(std::span<const TrueObject> truths, const GroundtruthComparison& comparison,
                        std::span<const size_t> sightings, size_t min_sightings);

// The errors of the true objects of one shape. If a true object was mapped several times, only the
// nearest mapped object counts.
struct ShapeErrors {
  size_t objects = 0;
  double center_share_mean = 0.0;
  double center_share_max = 0.0;
  double axis_ratio_mean = 0.0;       // over all axes; differs from 1 if lengths are biased
  double axis_ratio_deviation = 0.0;  // largest |ratio - 1|
  std::optional<double> siou_mean;    // over the objects that have a value
};

std::map<std::string, ShapeErrors> SummarizeByShape(std::span<const TrueObject> truths,
                                                    const GroundtruthComparison& comparison);

// A detection in a frame whose true pose is known.
struct SeenBox {
  std::string label;
  Eigen::AlignedBox2d box;  // undistorted, px
};

// Adds one to the count of each true object that a detection of the frame shows. A detection shows
// the true object of its class whose projected box, clipped to the image, has the largest
// intersection over union with the box of the detection, if this is more than 0.2.
void CountSightings(std::span<const TrueObject> truths, const PinholeCamera& camera,
                    const Rigid3& cam_from_truth, std::span<const SeenBox> seen,
                    std::vector<size_t>& sightings);

// The numbers of changes of one kind: true changes, reported changes, and reported changes that are
// right.
struct ChangeCounts {
  size_t in_truth = 0;
  size_t reported = 0;
  size_t right = 0;
};

struct ChangeComparison {
  ChangeCounts moved;
  ChangeCounts gone;
  ChangeCounts added;  // ObjectChange::kNew
  // Locations that an object left, and locations that an object newly takes. A moved object counts
  // in both, so it does not matter which of two cups was moved.
  ChangeCounts left;
  ChangeCounts taken;
};

// Compares the reported changes with a rearranged scene. A reported location agrees with a true
// object, of any class, if the distance of the two centres is at most half of the Size() of the
// true object. Each true object is counted once. Moving true objects are left out, and so are those
// of `scene.objects` whose entry in `sightings` is less than `min_sightings`; `sightings` may be
// empty. The scene is in metres; `truth_from_map` has the scale 1 if the map is in metres too.
ChangeComparison CompareChanges(const TrueScene& scene, std::span<const ChangedObject> changes,
                                const Sim3& truth_from_map, std::span<const size_t> sightings,
                                size_t min_sightings);

}  // namespace hullslam
