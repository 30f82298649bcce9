// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "eval/body_overlap.h"
#include "hullslam/geometry/alignment.h"
#include "hullslam/geometry/sim3.h"
#include "hullslam/util/id.h"
#include "report/object_results.h"

namespace hullslam {

// An object of a map compared with true bodies, which nobody has measured from the masks. (SIoU
// compares an object with the masks that it was made from.)

// A true object that stands still.
struct TrueBody {
  uint32_t id = 0;
  std::string label;
  std::string shape;  // by which the errors are summarised
  Body body;
  // The axes about which the body may be turned by any angle and looks the same. Two or more axes
  // make a sphere, whose orientation means nothing.
  std::array<bool, 3> is_round = {false, false, false};
  std::optional<uint32_t> masks = std::nullopt;  // number of masks of the sequence that show it
  bool is_counted =
      true;  // false if no view has seen it: it is no miss, and its match is not wrong
};

// A mapped object in the frame and in the unit of the truth.
struct MappedBody {
  ObjectId id;
  std::string label;
  Body body;
  size_t views = 0;  // that observe it: the confidence
  // Mean of d d^T over its views; d is the unit vector from the camera to the object.
  Eigen::Matrix3d sight = Eigen::Matrix3d::Zero();
};

// The mapped objects of a report, those with the most views first, then by id.
std::vector<MappedBody> MappedBodies(const ObjectResults& report, const Sim3& truth_from_map);

// How many bodies are found if a pair needs at least a given overlap. Mapped bodies take, in the
// order of their list, the free true body with the largest overlap (greedy, as in PASCAL VOC).
struct BodyScore {
  double least = 0.0;      // overlap of a pair
  size_t truths = 0;       // that are counted
  size_t predictions = 0;  // without those that match only truths that are not counted
  size_t right = 0;
  std::optional<double> precision;  // absent without predictions
  std::optional<double> recall;     // average recall at this overlap (AR); absent without truths
  // Area under the curve of precision over recall, where the precision at a recall is the largest
  // one at this recall or a higher one (all points, as PASCAL VOC since 2010).
  std::optional<double> average_precision;
};

// `overlaps` has a row for each mapped body, the most confident first, and a column for each truth.
BodyScore ScoreBodies(const Eigen::MatrixXd& overlaps, const std::vector<TrueBody>& truths,
                      double least);

// The errors of a mapped body. All lengths are relative: mapped over true half axis, minus 1.
struct BodyError {
  size_t truth = 0;  // indices
  size_t mapped = 0;
  double box_overlap = 0.0;
  double solid_overlap = 0.0;
  double center_m = 0.0;
  Eigen::Vector3d sorted_axes = Eigen::Vector3d::Zero();  // both sorted by length, longest first
  // The same along the axes of the true body, each with the axis of the mapped body that lies
  // nearest to it in the best of the 24 rotations that permute axes.
  Eigen::Vector3d along_axes = Eigen::Vector3d::Zero();
  // Mean squared cosine between each axis of the true body and the viewing directions.
  Eigen::Vector3d sight = Eigen::Vector3d::Zero();
  // Angle between the frames in that rotation, radians; of a round body, the angle between its axis
  // and the mapped axis next to it; absent for spheres.
  std::optional<double> turn;
};

BodyError CompareBodies(const TrueBody& truth, const MappedBody& mapped);

// Medians over the errors of a group of bodies; absent if the group is empty.
struct BodyErrors {
  size_t count = 0;
  std::optional<double> box_overlap, solid_overlap;  // means
  std::optional<double> center_m;
  std::array<std::optional<double>, 3> sorted_axes;  // signed, longest axis first
  std::optional<double> axes_median, axes_mean;      // of the sizes of all three
  std::optional<double> towards, across;  // signed, along_axes: of the axis with the largest
                                          // `sight`, and of the other two
  std::optional<double> turn;             // radians
};

BodyErrors SummarizeBodyErrors(const std::vector<BodyError>& errors);

struct BodyEvaluation {
  std::vector<TrueBody> truths;
  std::vector<MappedBody> mapped;
  bool have_common_class = true;
  // How the mapped bodies came into the frame of the truth.
  AlignmentKind alignment = AlignmentKind::kNone;
  double scale = 1.0;  // metres per unit of the map
  // For overlaps of 0.25 and 0.5, of boxes and of solids; pairs of any class, and of one class.
  std::array<BodyScore, 2> boxes, solids, boxes_of_class, solids_of_class;
  // The errors of pairs one to one with the least sum of distances between their centres, relative
  // to Body::Size() of the true one, each at most 0.5 (Hungarian); classes do not matter.
  std::vector<BodyError> errors;   // by truth; without truths that are not counted
  std::vector<size_t> missed;      // counted truths without a pair
  std::vector<size_t> duplicates;  // mapped bodies without a pair, as near to a truth that has one
  std::vector<size_t> false_ones;  // mapped bodies that are near no truth
};

BodyEvaluation EvaluateBodies(std::vector<TrueBody> truths, std::vector<MappedBody> mapped);

// The errors by TrueBody::shape.
std::map<std::string, BodyErrors> ErrorsByShape(const BodyEvaluation& evaluation);

}  // namespace hullslam
