// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/association.h"

#include <algorithm>
#include <cstddef>

#include "frame/detection/visible_part.h"
#include "geometry/assignment.h"
#include "geometry/polygon.h"
#include "objects/combined_similarity.h"
#include "objects/comparison/association_measure.h"
#include "objects/constraint/carried_hull.h"
#include "objects/constraint/point_statistics.h"
#include "objects/resolved_observation.h"
#include "util/id_set.h"
#include "util/lists.h"

namespace hullslam {
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
