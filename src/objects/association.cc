// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/association.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/assignment.h"
#include "geometry/convex_hull.h"
#include "geometry/polygon_overlap.h"
#include "objects/association_measure.h"
#include "objects/initialisation.h"
#include "objects/object_view.h"
#include "objects/point_statistics.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

constexpr int kDepthSteps = 4;  // between the positions of a carried hull of unknown depth

// The expected appearance of an object in the frame.
struct Prediction {
  ObjectId id;
  const ObjectLandmark* object = nullptr;
  std::optional<Ellipse> projected;        // absent without a shape
  Polygon ellipse;                         // projected, clipped to the image; empty without a shape
  std::vector<Polygon> carried;            // the last hull, moved to the frame's pose
  std::vector<LandmarkId> landmarks;       // in its latest views, sorted
  std::vector<Eigen::Vector3d> cloud;      // depth points of its last view, world
  std::vector<Eigen::Vector3d> centroids;  // one per latest view with depth, world
  double size = 0.0;                       // size of its cloud (SizeOf)
};

// A detection with all its data that is compared.
struct Seen {
  const Detection* detection = nullptr;
  std::vector<LandmarkId> landmarks;  // sorted
  std::vector<Eigen::Vector3d> cloud;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  // centroid of the cloud
  double noise = 0.0;                                  // noise of the centroid, in units of the map
};

// Twice the root mean square distance of the points from their mean. It is about half the diagonal
// of their box.
double SizeOf(std::span<const Eigen::Vector3d> points) {
  const Eigen::Vector3d mean = MeanOf(points);
  double sum = 0.0;
  for (const Eigen::Vector3d& point : points) {
    sum += (point - mean).squaredNorm();
  }
  return 2.0 * std::sqrt(sum / static_cast<double>(std::max<size_t>(1, points.size())));
}

class Associator {
 public:
  Associator(const Map& map, const ObjectIndex& index, const Sensor& sensor, const Frame& frame,
             const Rigid3& cam_from_world, IslandId island, std::span<const LandmarkId> landmarks,
             AssociationScope scope, const AssociationOptions& options)
      : map_(map),
        index_(index),
        sensor_(sensor),
        frame_(frame),
        cam_from_world_(cam_from_world),
        island_(island),
        landmarks_(landmarks),
        scope_(scope),
        options_(options),
        function_(FunctionOf(options.measure)),
        image_(Eigen::Vector2d(sensor.bounds.min_x, sensor.bounds.min_y),
               Eigen::Vector2d(sensor.bounds.max_x, sensor.bounds.max_y)) {}

  std::vector<ObjectId> Run() const {
    std::vector<Seen> seen;
    seen.reserve(frame_.detections.size());
    for (const Detection& detection : frame_.detections) {
      seen.push_back(Look(detection));
    }
    const std::vector<Prediction> predictions = PredictAll(seen);
    Eigen::MatrixXd cost(static_cast<Eigen::Index>(seen.size()),
                         static_cast<Eigen::Index>(predictions.size()));
    for (Eigen::Index i = 0; i < cost.rows(); ++i) {
      for (Eigen::Index j = 0; j < cost.cols(); ++j) {
        cost(i, j) =
            1.0 - Similarity(seen[static_cast<size_t>(i)], predictions[static_cast<size_t>(j)]);
      }
    }
    std::vector<ObjectId> objects(frame_.detections.size());
    const std::vector<int> columns = AssignMinimumCost(cost, 1.0 - LeastSimilarity());
    for (size_t i = 0; i < columns.size(); ++i) {
      if (columns[i] >= 0) {
        objects[i] = predictions[static_cast<size_t>(columns[i])].id;
      }
    }
    return objects;
  }

 private:
  // Predictions of all objects that any of the detections can show, by increasing id.
  std::vector<Prediction> PredictAll(std::span<const Seen> seen) const {
    std::vector<Prediction> predictions;
    for (const ObjectId id : FindCandidates()) {
      const ObjectLandmark& object = map_.objects().At(id);
      const bool is_wanted =
          scope_ == AssociationScope::kAll || object.state == ObjectState::kMapped;
      if (!is_wanted || object.observations.empty()) {
        continue;
      }
      std::vector<ObjectView> views =
          LatestViews(map_, object, static_cast<size_t>(options_.recent_views));
      Prediction prediction = Locate(id, object, views.back());
      const bool is_elsewhere = std::all_of(
          seen.begin(), seen.end(), [&](const Seen& one) { return AreApart(one, prediction); });
      if (!is_elsewhere) {
        AddSurfaceLandmarks(map_, {&views.back(), 1});  // the last hull is carried at their depth
        Predict(views, prediction);
        predictions.push_back(std::move(prediction));
      }
    }
    return predictions;
  }

  // A detection can only show an object whose prediction reaches into the image, or one that shares
  // landmarks with it. Such an object is observed by a keyframe that observes the landmarks.
  std::vector<ObjectId> FindCandidates() const {
    std::vector<ObjectId> candidates = index_.FindVisible(sensor_, cam_from_world_, island_);
    IdSet<KeyframeId> observers;
    for (const Detection& detection : frame_.detections) {
      for (const uint32_t keypoint : detection.keypoints) {
        const Landmark* landmark =
            keypoint < landmarks_.size() ? map_.landmarks().Find(landmarks_[keypoint]) : nullptr;
        if (landmark == nullptr) {
          continue;
        }
        for (const Observation& observation : landmark->observations) {
          observers.Insert(observation.keyframe);
        }
      }
    }
    for (const KeyframeId observer : observers.Sorted()) {
      for (const ObjectId object : map_.keyframes().At(observer).objects) {
        if (object.IsValid()) {
          candidates.push_back(object);
        }
      }
    }
    SortUnique(candidates);
    return candidates;
  }

  // A prediction with the cloud only.
  Prediction Locate(ObjectId id, const ObjectLandmark& object, const ObjectView& last) const {
    Prediction prediction;
    prediction.id = id;
    prediction.object = &object;
    prediction.cloud = CollectPoints({&last, 1}, static_cast<size_t>(options_.cloud_points));
    prediction.size = SizeOf(prediction.cloud);
    return prediction;
  }

  // Completes a prediction from the latest views of the object.
  void Predict(std::span<const ObjectView> views, Prediction& prediction) const {
    if (prediction.object->has_shape) {
      prediction.projected =
          ProjectEllipsoid(sensor_.camera.Matrix(), cam_from_world_, prediction.object->ellipsoid);
      if (prediction.projected) {
        prediction.ellipse = ClipToBox(prediction.projected->Polygon(32), image_);
      }
    }
    prediction.carried = Carry(views);
    for (const ObjectView& view : views) {
      if (!view.detection->points.empty()) {
        prediction.centroids.push_back(Centroid(view));
      }
      for (const uint32_t keypoint : view.detection->keypoints) {
        AddLandmark(map_.keyframes().At(view.keyframe).landmarks[keypoint], prediction.landmarks);
      }
    }
    SortUnique(prediction.landmarks);
  }

  // The last hull of an object, moved to the frame's pose. All its corners get one inverse depth (1
  // / m): that of the depth points, or that of the point where the rays to the object meet. If
  // neither is known, there is one hull per possible inverse depth.
  std::vector<Polygon> Carry(std::span<const ObjectView> views) const {
    const ObjectView& last = views.back();
    std::vector<Polygon> carried;
    for (const double inverse_depth : InverseDepths(views)) {
      carried.push_back(Move(last, inverse_depth));
    }
    return carried;
  }

  std::vector<double> InverseDepths(std::span<const ObjectView> views) const {
    const ObjectView& last = views.back();
    if (!last.detection->points.empty()) {
      return {1.0 / MeanOf(last.detection->points.Unpack()).z()};
    }
    if (const auto depth = LandmarkDepth(last)) {
      return {1.0 / *depth};
    }
    if (const auto sphere = StartFromRays(sensor_.camera, views, {})) {
      return {1.0 / (last.cam_from_world * sphere->world_from_object.translation).z()};
    }
    // The inverse depths range from 0 to the value at which the hull moves by its own size.
    const Rigid3 now_from_then = cam_from_world_ * Inverse(last.cam_from_world);
    const Eigen::Vector3d ray = sensor_.camera.Unproject(last.detection->box.center(), 1.0);
    const Eigen::Vector3d far = now_from_then.rotation * ray;
    if (far.z() <= 0.0) {
      return {};
    }
    // Derivative of the pixel by the inverse depth where it is 0.
    const Eigen::Vector2d slope =
        Eigen::Vector2d(sensor_.camera.fx, sensor_.camera.fy)
            .cwiseProduct(now_from_then.translation.head<2>() / far.z() -
                          far.head<2>() * now_from_then.translation.z() / (far.z() * far.z()));
    const double size = last.detection->box.sizes().minCoeff();
    std::vector<double> inverse_depths = {0.0};
    if (slope.norm() > 1.0) {  // px m; a smaller slope moves the hull too little
      for (int i = 1; i <= kDepthSteps; ++i) {
        inverse_depths.push_back(i * size / (kDepthSteps * slope.norm()));
      }
    }
    return inverse_depths;
  }

  // The hull of a view, moved to the frame's pose; empty if it is not in front of the camera.
  Polygon Move(const ObjectView& view, double inverse_depth) const {
    const Rigid3 now_from_then = cam_from_world_ * Inverse(view.cam_from_world);
    Polygon moved;
    for (const Eigen::Vector2d& corner : view.detection->hull) {
      const Eigen::Vector3d point = now_from_then.rotation * sensor_.camera.Unproject(corner, 1.0) +
                                    inverse_depth * now_from_then.translation;
      if (point.z() <= 0.0) {
        return {};
      }
      moved.push_back(sensor_.camera.Project(point));
    }
    return ClipToBox(ConvexHull(moved), image_);
  }

  Seen Look(const Detection& detection) const {
    Seen seen;
    seen.detection = &detection;
    const ObjectView view{KeyframeId(), cam_from_world_, &detection};
    seen.cloud = CollectPoints({&view, 1}, static_cast<size_t>(options_.cloud_points));
    seen.centroid = MeanOf(seen.cloud);
    seen.noise = options_.centroid_noise * (cam_from_world_ * seen.centroid).norm();
    for (const uint32_t keypoint : detection.keypoints) {
      if (keypoint < landmarks_.size()) {
        AddLandmark(landmarks_[keypoint], seen.landmarks);
      }
    }
    SortUnique(seen.landmarks);
    return seen;
  }

  static void AddLandmark(LandmarkId landmark, std::vector<LandmarkId>& landmarks) {
    if (landmark.IsValid()) {
      landmarks.push_back(landmark);
    }
  }
  template <typename IdType>
  static void SortUnique(std::vector<IdType>& ids) {
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  }

  // Whether the clouds of depth points are so far apart that they cannot belong to the same object.
  bool AreApart(const Seen& seen, const Prediction& prediction) const {
    if (seen.cloud.empty() || prediction.cloud.empty()) {
      return false;
    }
    const double size = std::max(prediction.size, SizeOf(seen.cloud));
    const double offset = (seen.centroid - MeanOf(prediction.cloud)).norm();
    return offset > options_.max_offset * size + seen.noise;
  }

  static size_t CountShared(const Seen& seen, const Prediction& prediction) {
    std::vector<LandmarkId> shared;
    std::set_intersection(seen.landmarks.begin(), seen.landmarks.end(),
                          prediction.landmarks.begin(), prediction.landmarks.end(),
                          std::back_inserter(shared));
    return shared.size();
  }

  // Number of common landmarks over the number of landmarks of the one that has fewer; 0 for few
  // common landmarks.
  double SharedLandmarks(const Seen& seen, const Prediction& prediction) const {
    const size_t shared = CountShared(seen, prediction);
    if (shared < static_cast<size_t>(options_.min_shared_landmarks)) {
      return 0.0;
    }
    return static_cast<double>(shared) /
           static_cast<double>(std::min(seen.landmarks.size(), prediction.landmarks.size()));
  }

  double ClassShare(const std::string& label, const ObjectLandmark& object) const {
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
  double CarriedOverlap(const Seen& seen, const Prediction& prediction) const {
    if (prediction.carried.size() > 1 && seen.detection->label != prediction.object->Label()) {
      return 0.0;
    }
    double overlap = 0.0;
    for (const Polygon& carried : prediction.carried) {
      overlap = std::max(overlap, IntersectionOverUnion(seen.detection->hull, carried));
    }
    return overlap;
  }

  // The least similarity of a match. The other measures have conditions of their own.
  double LeastSimilarity() const {
    constexpr double kMoreThanNone = 1e-6;
    return function_ == nullptr ? options_.min_similarity : kMoreThanNone;
  }

  double Similarity(const Seen& seen, const Prediction& prediction) const {
    return function_ == nullptr ? CombinedSimilarity(seen, prediction)
                                : function_({.detection = *seen.detection,
                                             .object = *prediction.object,
                                             .projected = prediction.projected,
                                             .carried = prediction.carried,
                                             .shared_landmarks = CountShared(seen, prediction)});
  }

  // 0 if they do not match, otherwise up to the sum of the weights (1.2 by default).
  double CombinedSimilarity(const Seen& seen, const Prediction& prediction) const {
    if (AreApart(seen, prediction)) {
      return 0.0;
    }
    const Polygon& hull = seen.detection->hull;
    const double projected = IntersectionOverUnion(hull, prediction.ellipse);
    const double carried = CarriedOverlap(seen, prediction);
    const double shared = SharedLandmarks(seen, prediction);
    const bool one_cloud = MayBeOneCloud(seen.cloud, prediction.cloud, options_.max_rank_sum,
                                         static_cast<size_t>(options_.min_cloud));
    const bool one_centroid =
        !seen.cloud.empty() &&
        MayBeTheMean(seen.centroid, prediction.centroids, options_.alpha, seen.noise);
    const bool is_match =
        projected >= options_.min_projection_iou || carried >= options_.min_carried_iou ||
        shared >= options_.min_shared_ratio ||
        ((one_cloud || one_centroid) && std::max(projected, carried) > options_.min_depth_iou);
    if (!is_match) {
      return 0.0;
    }
    const double clouds =
        (one_cloud ? options_.cloud_weight : 0.0) + (one_centroid ? options_.centroid_weight : 0.0);
    return options_.iou_weight * std::max(projected, carried) + options_.landmark_weight * shared +
           clouds + options_.class_weight * ClassShare(seen.detection->label, *prediction.object);
  }

  const Map& map_;
  const ObjectIndex& index_;
  const Sensor& sensor_;
  const Frame& frame_;
  const Rigid3& cam_from_world_;
  const IslandId island_;
  std::span<const LandmarkId> landmarks_;
  AssociationScope scope_;
  const AssociationOptions& options_;
  SimilarityFunction* const function_;  // null for the measure kCombined
  Eigen::AlignedBox2d image_;
};

}  // namespace

std::vector<ObjectId> AssociateDetections(const Map& map, const ObjectIndex& index,
                                          const Sensor& sensor, const Frame& frame,
                                          const Rigid3& cam_from_world, IslandId island,
                                          std::span<const LandmarkId> landmarks,
                                          AssociationScope scope,
                                          const AssociationOptions& options) {
  return Associator(map, index, sensor, frame, cam_from_world, island, landmarks, scope, options)
      .Run();
}

}  // namespace hullslam
