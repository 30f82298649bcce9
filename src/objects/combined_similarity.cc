// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/combined_similarity.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "geometry/polygon.h"
#include "objects/constraint/point_statistics.h"

namespace hullslam {
namespace {

// Number of common landmarks over the number of landmarks of the one that has fewer; 0 for few
// common landmarks.
double SharedLandmarks(const SeenObject& seen, const PredictedObject& predicted,
                       const AssociationOptions& options) {
  const size_t shared = CountShared(seen, predicted);
  if (shared < static_cast<size_t>(options.min_shared_landmarks)) {
    return 0.0;
  }
  return static_cast<double>(shared) /
         static_cast<double>(std::min(seen.landmarks.size(), predicted.landmarks.size()));
}

double ClassShare(const std::string& label, const ObjectLandmark& object) {
  double total = 0.0;
  double same = 0.0;
  for (const auto& [name, votes] : object.votes) {
    total += votes;
    same += name == label ? votes : 0.0;
  }
  return total > 0.0 ? same / total : 0.0;
}

// The largest IoU with a carried hull. If the depth of the object is not known, the hull can be
// carried to many positions, so the class must agree too.
double CarriedOverlap(const SeenObject& seen, const PredictedObject& predicted) {
  if (predicted.carried.size() > 1 && seen.detection->label != predicted.object->Label()) {
    return 0.0;
  }
  double overlap = 0.0;
  for (const std::vector<Eigen::Vector2d>& carried : predicted.carried) {
    overlap = std::max(overlap, IntersectionOverUnion(seen.detection->hull, carried));
  }
  return overlap;
}

}  // namespace

double SizeOf(std::span<const Eigen::Vector3d> points) {
  const Eigen::Vector3d mean = MeanOf(points);
  double sum = 0.0;
  for (const Eigen::Vector3d& point : points) {
    sum += (point - mean).squaredNorm();
  }
  return 2.0 * std::sqrt(sum / static_cast<double>(std::max<size_t>(1, points.size())));
}

bool AreApart(const SeenObject& seen, const PredictedObject& predicted,
              const AssociationOptions& options) {
  if (seen.cloud.empty() || predicted.cloud.empty()) {
    return false;
  }
  const double size = std::max(predicted.size, SizeOf(seen.cloud));
  const double offset = (seen.centroid - MeanOf(predicted.cloud)).norm();
  return offset > options.max_offset * size + seen.noise;
}

size_t CountShared(const SeenObject& seen, const PredictedObject& predicted) {
  std::vector<LandmarkId> shared;
  std::set_intersection(seen.landmarks.begin(), seen.landmarks.end(), predicted.landmarks.begin(),
                        predicted.landmarks.end(), std::back_inserter(shared));
  return shared.size();
}

double CombinedSimilarity(const SeenObject& seen, const PredictedObject& predicted,
                          const AssociationOptions& options) {
  if (AreApart(seen, predicted, options)) {
    return 0.0;
  }
  const double projected = IntersectionOverUnion(seen.detection->hull, predicted.ellipse);
  const double carried = CarriedOverlap(seen, predicted);
  const double shared = SharedLandmarks(seen, predicted, options);
  const bool one_cloud = MayBeOneCloud(seen.cloud, predicted.cloud, options.max_rank_sum,
                                       static_cast<size_t>(options.min_cloud));
  const bool one_centroid = !seen.cloud.empty() && MayBeTheMean(seen.centroid, predicted.centroids,
                                                                options.alpha, seen.noise);
  const bool is_match =
      projected >= options.min_projection_iou || carried >= options.min_carried_iou ||
      shared >= options.min_shared_ratio ||
      ((one_cloud || one_centroid) && std::max(projected, carried) > options.min_depth_iou);
  if (!is_match) {
    return 0.0;
  }
  const double clouds =
      (one_cloud ? options.cloud_weight : 0.0) + (one_centroid ? options.centroid_weight : 0.0);
  return options.iou_weight * std::max(projected, carried) + options.landmark_weight * shared +
         clouds + options.class_weight * ClassShare(seen.detection->label, *predicted.object);
}

}  // namespace hullslam
