// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hullslam/report/object_report.h"
#include "hullslam/eval/true_object.h"

namespace hullslam {

// A mapped object beside the true one it stands for.
struct ObjectError {
  ObjectId object;
  size_t truth = 0;               // index of the true object
  double center_m = 0.0;          // distance of the centres
  double center_share = 0.0;      // of the true object's Size()
  Eigen::Vector3d axis_ratios;    // mapped over true half axes, paired by length, longest first
  Eigen::Vector3d extent_ratios;  // mapped over true half extents along the true object's axes
  std::optional<double> siou;     // of the mapped object (ObjectFit)
};

struct GroundtruthComparison {
  std::vector<ObjectError> errors;      // by true object, the nearest first
  std::vector<ObjectId> without_truth;  // mapped where no true object is
  std::vector<size_t> times_mapped;     // of each true object
};

// Gives every mapped object of the report the true object whose centre is nearest in shares of its
// size, if it is within half of it; classes don't matter. Moving objects stand for nothing.
GroundtruthComparison CompareWithTruth(std::span<const TrueObject> truths,
                                       const ObjectReport& report, const Rigid3& truth_from_map);

// How many true objects that can be asked for are mapped how often.
struct TruthCounts {
  size_t visible = 0;  // seen often enough, and at rest
  size_t once = 0;     // of these mapped as one object
  size_t more = 0;     // as several
  size_t never = 0;
};

// Of the objects with `min_sightings` or more; without counts of sightings all are visible.
TruthCounts CountMapped(std::span<const TrueObject> truths, const GroundtruthComparison& comparison,
                        std::span<const size_t> sightings, size_t min_sightings);

// The errors of the true objects of one shape, of each the nearest mapped one.
struct ShapeErrors {
  size_t objects = 0;
  double center_share_mean = 0.0;
  double center_share_max = 0.0;
  double axis_ratio_mean = 0.0;       // over all axes: the bias of their lengths
  double axis_ratio_deviation = 0.0;  // largest |ratio - 1|
  std::optional<double> siou_mean;    // over the objects that have one
};

std::map<std::string, ShapeErrors> SummarizeByShape(std::span<const TrueObject> truths,
                                                    const GroundtruthComparison& comparison);

// A detection of a frame whose true pose is known.
struct SeenBox {
  std::string label;
  Eigen::AlignedBox2d box;  // undistorted, px
};

// Adds one to the count of every true object that a detection of the frame shows: the one of its
// class whose projection's box, cut to the image, overlaps the detection's box most, at least by a
// fifth (intersection over union).
void CountSightings(std::span<const TrueObject> truths, const PinholeCamera& camera,
                    const Rigid3& cam_from_truth, std::span<const SeenBox> seen,
                    std::vector<size_t>& sightings);

}  // namespace hullslam
