// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/object_groundtruth.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include "geometry/polygon.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/util/check.h"

namespace hullslam {
namespace {

Eigen::Vector3d LongestFirst(Eigen::Vector3d axes) {
  std::sort(axes.begin(), axes.end(), std::greater<>());
  return axes;
}

// Half extents of an ellipsoid along the axes of `world_from_frame`.
Eigen::Vector3d ExtentsAlong(const Ellipsoid& ellipsoid, const Rigid3& world_from_frame) {
  const Eigen::Matrix3d axes_in_frame =
      (world_from_frame.rotation.inverse() * ellipsoid.world_from_object.rotation)
          .toRotationMatrix() *
      ellipsoid.half_axes.asDiagonal();
  return axes_in_frame.rowwise().norm();
}

ObjectError Compare(const TrueObject& truth, const Ellipsoid& mapped) {
  ObjectError error;
  error.center_m =
      (mapped.world_from_object.translation - truth.world_from_object.translation).norm();
  error.center_share = error.center_m / truth.Size();
  error.axis_ratios =
      LongestFirst(mapped.half_axes).cwiseQuotient(LongestFirst(truth.half_extents));
  error.extent_ratios =
      ExtentsAlong(mapped, truth.world_from_object).cwiseQuotient(truth.half_extents);
  return error;
}

// Compares with the nearest true object, or returns nothing if none is near enough.
std::optional<ObjectError> CompareWithNearest(std::span<const TrueObject> truths,
                                              const Ellipsoid& mapped) {
  constexpr double kFarthest = 0.5;
  std::optional<ObjectError> nearest;
  for (size_t i = 0; i < truths.size(); ++i) {
    if (truths[i].is_dynamic) {
      continue;
    }
    ObjectError error = Compare(truths[i], mapped);
    error.truth = i;
    if (error.center_share <= kFarthest &&
        (!nearest || error.center_share < nearest->center_share)) {
      nearest = error;
    }
  }
  return nearest;
}

// The box of each object in the image; empty if the object is not in the image or moves.
std::vector<Eigen::AlignedBox2d> ProjectBoxes(std::span<const TrueObject> truths,
                                              const PinholeCamera& camera,
                                              const Rigid3& cam_from_truth) {
  const PinholeCamera::Bounds bounds = camera.UndistortedBounds();
  const Eigen::AlignedBox2d image(Eigen::Vector2d(bounds.min_x, bounds.min_y),
                                  Eigen::Vector2d(bounds.max_x, bounds.max_y));
  std::vector<Eigen::AlignedBox2d> boxes(truths.size());
  for (size_t i = 0; i < truths.size(); ++i) {
    const Ellipsoid ellipsoid = {truths[i].world_from_object, truths[i].half_extents};
    const std::optional<Ellipse> ellipse =
        ProjectEllipsoid(camera.Matrix(), cam_from_truth, ellipsoid);
    if (ellipse && !truths[i].is_dynamic) {
      boxes[i] = ellipse->Bounds().intersection(image);
    }
  }
  return boxes;
}

std::optional<size_t> FindShown(std::span<const TrueObject> truths,
                                std::span<const Eigen::AlignedBox2d> boxes, const SeenBox& seen) {
  double best_overlap = 0.2;
  std::optional<size_t> best;
  for (size_t i = 0; i < truths.size(); ++i) {
    const double overlap =
        truths[i].label == seen.label ? IntersectionOverUnion(boxes[i], seen.box) : 0.0;
    if (overlap > best_overlap) {
      best_overlap = overlap;
      best = i;
    }
  }
  return best;
}

}  // namespace

GroundtruthComparison CompareWithTruth(std::span<const TrueObject> truths,
                                       const ObjectResults& report, const Sim3& truth_from_map) {
  GroundtruthComparison comparison;
  comparison.times_mapped.assign(truths.size(), 0);
  for (const ObjectResult& object : report.objects) {
    if (object.state != ObjectState::kMapped) {
      continue;
    }
    std::optional<ObjectError> error =
        CompareWithNearest(truths, truth_from_map * object.ellipsoid);
    if (!error) {
      comparison.without_truth.push_back(object.id);
      continue;
    }
    error->object = object.id;
    error->siou = object.fit.siou;
    ++comparison.times_mapped[error->truth];
    comparison.errors.push_back(*error);
  }
  std::stable_sort(comparison.errors.begin(), comparison.errors.end(),
                   [](const ObjectError& a, const ObjectError& b) {
                     return std::pair(a.truth, a.center_share) < std::pair(b.truth, b.center_share);
                   });
  return comparison;
}

TruthCounts CountMapped(std::span<const TrueObject> truths, const GroundtruthComparison& comparison,
                        std::span<const size_t> sightings, size_t min_sightings) {
  TruthCounts counts;
  for (size_t i = 0; i < truths.size(); ++i) {
    if (truths[i].is_dynamic || (!sightings.empty() && sightings[i] < min_sightings)) {
      continue;
    }
    ++counts.visible;
    const size_t times = comparison.times_mapped[i];
    counts.never += times == 0 ? 1 : 0;
    counts.once += times == 1 ? 1 : 0;
    counts.more += times > 1 ? 1 : 0;
  }
  return counts;
}

std::map<std::string, ShapeErrors> SummarizeByShape(std::span<const TrueObject> truths,
                                                    const GroundtruthComparison& comparison) {
  std::map<std::string, ShapeErrors> shapes;
  std::map<std::string, size_t> with_siou;
  std::optional<size_t> last;
  for (const ObjectError& error : comparison.errors) {
    if (last == error.truth) {
      continue;  // mapped several times; the nearest came first
    }
    last = error.truth;
    ShapeErrors& shape = shapes[truths[error.truth].shape];
    ++shape.objects;
    shape.center_share_mean += error.center_share;
    shape.center_share_max = std::max(shape.center_share_max, error.center_share);
    shape.axis_ratio_mean += error.axis_ratios.mean();
    shape.axis_ratio_deviation =
        std::max(shape.axis_ratio_deviation, (error.axis_ratios.array() - 1.0).abs().maxCoeff());
    if (error.siou) {
      shape.siou_mean = shape.siou_mean.value_or(0.0) + *error.siou;
      ++with_siou[truths[error.truth].shape];
    }
  }
  for (auto& [name, shape] : shapes) {
    shape.center_share_mean /= static_cast<double>(shape.objects);
    shape.axis_ratio_mean /= static_cast<double>(shape.objects);
    if (shape.siou_mean) {
      *shape.siou_mean /= static_cast<double>(with_siou[name]);
    }
  }
  return shapes;
}

void CountSightings(std::span<const TrueObject> truths, const PinholeCamera& camera,
                    const Rigid3& cam_from_truth, std::span<const SeenBox> seen,
                    std::vector<size_t>& sightings) {
  Check(sightings.size() == truths.size(), "sightings need one count per true object");
  const std::vector<Eigen::AlignedBox2d> boxes = ProjectBoxes(truths, camera, cam_from_truth);
  std::vector<bool> is_shown(truths.size(), false);
  for (const SeenBox& detection : seen) {
    if (const std::optional<size_t> shown = FindShown(truths, boxes, detection)) {
      is_shown[*shown] = true;
    }
  }
  for (size_t i = 0; i < truths.size(); ++i) {
    sightings[i] += is_shown[i] ? 1 : 0;
  }
}

}  // namespace hullslam
