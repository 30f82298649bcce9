// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/association.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string>

#include "frame/detection/visible_part.h"
#include "geometry/assignment.h"
#include "geometry/polygon.h"
#include "objects/comparison/association_measure.h"
#include "objects/constraint/carried_hull.h"
#include "objects/constraint/point_statistics.h"
#include "objects/resolved_observation.h"
#include "util/id_set.h"
#include "util/lists.h"

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
  const double size = std::max(predicted.size, seen.size);
  const double offset = (seen.centroid - predicted.centroid).norm();
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
  const bool is_alike = projected >= options.min_projection_iou ||
                        carried >= options.min_carried_iou || shared >= options.min_shared_ratio;
  const bool may_be_alike = std::max(projected, carried) > options.min_depth_iou;
  if (!is_alike && !may_be_alike) {
    return 0.0;  // most pairs, so their clouds are not compared
  }
  const bool one_cloud = MayBeOneCloud(seen.cloud, predicted.cloud, options.max_rank_sum,
                                       static_cast<size_t>(options.min_cloud));
  const bool one_centroid = !seen.cloud.empty() && MayBeTheMean(seen.centroid, predicted.centroids,
                                                                options.alpha, seen.noise);
  if (!is_alike && !one_cloud && !one_centroid) {
    return 0.0;
  }
  const double clouds =
      (one_cloud ? options.cloud_weight : 0.0) + (one_centroid ? options.centroid_weight : 0.0);
  return options.iou_weight * std::max(projected, carried) + options.landmark_weight * shared +
         clouds + options.class_weight * ClassShare(seen.detection->label, *predicted.object);
}

namespace {

void AddLandmark(LandmarkId landmark, std::vector<LandmarkId>& landmarks) {
  if (landmark.IsValid()) {
    landmarks.push_back(landmark);
  }
}

SeenObject Look(const AssociationInput& input, const Detection& detection,
                const AssociationOptions& options) {
  SeenObject seen;
  seen.detection = &detection;
  const ResolvedObservation observation{KeyframeId(), input.cam_from_world, &detection};
  seen.cloud = CollectPoints({&observation, 1}, static_cast<size_t>(options.cloud_points));
  seen.centroid = MeanOf(seen.cloud);
  seen.size = SizeOf(seen.cloud);
  seen.noise = options.centroid_noise * (input.cam_from_world * seen.centroid).norm();
  for (const uint32_t keypoint : detection.keypoints) {
    if (keypoint < input.landmarks.size()) {
      AddLandmark(input.landmarks[keypoint], seen.landmarks);
    }
  }
  SortUnique(seen.landmarks);
  return seen;
}

// A detection can only show an object whose prediction reaches into the image, or one that shares
// landmarks with it. Such an object is observed by a keyframe that observes the landmarks.
std::vector<ObjectId> FindCandidates(const AssociationInput& input) {
  std::vector<ObjectId> candidates =
      input.index.FindVisible(input.sensor, input.cam_from_world, input.island);
  IdSet<KeyframeId> observers;
  for (const Detection& detection : input.frame.detections) {
    for (const uint32_t keypoint : detection.keypoints) {
      const Landmark* const landmark = keypoint < input.landmarks.size()
                                           ? input.map.landmarks().Find(input.landmarks[keypoint])
                                           : nullptr;
      if (landmark == nullptr) {
        continue;
      }
      for (const Observation& observation : landmark->observations) {
        observers.Insert(observation.keyframe);
      }
    }
  }
  for (const KeyframeId observer : observers.Sorted()) {
    for (const ObjectId object : input.map.keyframes().At(observer).objects) {
      if (object.IsValid()) {
        candidates.push_back(object);
      }
    }
  }
  SortUnique(candidates);
  return candidates;
}

// A prediction with the cloud of the last observation only.
PredictedObject Locate(ObjectId id, const ObjectLandmark& object, const ResolvedObservation& last,
                       const AssociationOptions& options) {
  PredictedObject predicted;
  predicted.id = id;
  predicted.object = &object;
  predicted.cloud = CollectPoints({&last, 1}, static_cast<size_t>(options.cloud_points));
  predicted.centroid = MeanOf(predicted.cloud);
  predicted.size = SizeOf(predicted.cloud);
  return predicted;
}

// Completes a prediction from the latest observations of the object.
void Predict(const AssociationInput& input, std::span<const ResolvedObservation> observations,
             PredictedObject& predicted) {
  const Sensor& sensor = input.sensor;
  if (predicted.object->has_shape) {
    predicted.projected =
        ProjectEllipsoid(sensor.camera.Matrix(), input.cam_from_world, predicted.object->ellipsoid);
  }
  if (predicted.projected) {
    const Eigen::AlignedBox2d image(Eigen::Vector2d(sensor.bounds.min_x, sensor.bounds.min_y),
                                    Eigen::Vector2d(sensor.bounds.max_x, sensor.bounds.max_y));
    predicted.ellipse = VisiblePart(predicted.projected->Polygon(32), sensor.camera, image);
  }
  predicted.carried = CarryHull(sensor, observations, input.cam_from_world);
  for (const ResolvedObservation& observation : observations) {
    if (!observation.detection->points.empty()) {
      predicted.centroids.push_back(Centroid(observation));
    }
    for (const uint32_t keypoint : observation.detection->keypoints) {
      AddLandmark(input.map.keyframes().At(observation.keyframe).landmarks[keypoint],
                  predicted.landmarks);
    }
  }
  SortUnique(predicted.landmarks);
}

// Predictions of all objects that any of the detections can show, by increasing id.
std::vector<PredictedObject> PredictAll(const AssociationInput& input,
                                        std::span<const SeenObject> seen,
                                        const AssociationOptions& options) {
  std::vector<PredictedObject> all;
  for (const ObjectId id : FindCandidates(input)) {
    const ObjectLandmark& object = input.map.objects().At(id);
    const bool is_wanted =
        input.scope == AssociationScope::kAll || object.state == ObjectState::kMapped;
    if (!is_wanted || object.observations.empty()) {
      continue;
    }
    std::vector<ResolvedObservation> observations =
        LatestObservations(input.map, object, static_cast<size_t>(options.recent_views));
    PredictedObject predicted = Locate(id, object, observations.back(), options);
    const bool is_elsewhere = std::all_of(seen.begin(), seen.end(), [&](const SeenObject& one) {
      return AreApart(one, predicted, options);
    });
    if (!is_elsewhere) {
      AddSurfaceLandmarks(input.map,
                          {&observations.back(), 1});  // the last hull is carried at their depth
      Predict(input, observations, predicted);
      all.push_back(std::move(predicted));
    }
  }
  return all;
}

double Similarity(const SeenObject& seen, const PredictedObject& predicted,
                  SimilarityFunction* function, const AssociationOptions& options) {
  return function == nullptr ? CombinedSimilarity(seen, predicted, options)
                             : function({.detection = *seen.detection,
                                         .object = *predicted.object,
                                         .projected = predicted.projected,
                                         .carried = predicted.carried,
                                         .shared_landmarks = CountShared(seen, predicted)});
}

}  // namespace

std::vector<ObjectId> AssociateDetections(const AssociationInput& input,
                                          const AssociationOptions& options) {
  std::vector<SeenObject> seen;
  seen.reserve(input.frame.detections.size());
  for (const Detection& detection : input.frame.detections) {
    seen.push_back(Look(input, detection, options));
  }
  const std::vector<PredictedObject> predicted = PredictAll(input, seen, options);
  SimilarityFunction* const function = FunctionOf(options.measure);  // null for kCombined
  Eigen::MatrixXd cost(static_cast<Eigen::Index>(seen.size()),
                       static_cast<Eigen::Index>(predicted.size()));
  for (size_t i = 0; i < seen.size(); ++i) {
    for (size_t j = 0; j < predicted.size(); ++j) {
      cost(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          1.0 - Similarity(seen[i], predicted[j], function, options);
    }
  }
  constexpr double kMoreThanNone = 1e-6;  // the other measures have conditions of their own
  const double least = function == nullptr ? options.min_similarity : kMoreThanNone;
  const std::vector<int> columns = AssignMinimumCost(cost, 1.0 - least);
  std::vector<ObjectId> objects(seen.size());
  for (size_t i = 0; i < columns.size(); ++i) {
    if (columns[i] >= 0) {
      objects[i] = predicted[static_cast<size_t>(columns[i])].id;
    }
  }
  return objects;
}

}  // namespace hullslam
