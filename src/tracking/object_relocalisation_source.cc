// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>
#include <vector>

#include "estimators/absolute_pose.h"
#include "frame/measure_point.h"
#include "map/covisibility.h"
#include "map/islands.h"
#include "map/landmark_projection.h"
#include "matching/by_projection.h"
#include "objects/arrangement.h"
#include "objects/pose_hypotheses.h"
#include "places/landmark_search.h"
#include "tracking/pose_objects.h"
#include "tracking/pose_refinement.h"
#include "tracking/pose_source.h"
#include "util/id_map.h"
#include "util/random_seed.h"

namespace hullslam {
namespace {

constexpr size_t kMostRefined = 6;     // hypotheses
constexpr size_t kMostObservers = 30;  // keyframes whose landmarks are searched
constexpr int kRounds = 2;             // of matching and refinement with objects alone
constexpr float kWideRadius = 25.0f;   // px at level 0; objects give a pose to a few centimetres
constexpr double kWideRatio = 0.8;
constexpr double kLeastMeanOverlap = 0.5;  // of the objects that confirm a pose
// Hypotheses with a smaller share of the best score of objects are not looked at any further.
constexpr double kWorthyShare = 0.5;
constexpr int kMostSamples = 200;  // of RANSAC; most of the landmarks near a true pose agree
// A second place that explains the frame this well, as a share of the best one, makes the frame
// ambiguous.
constexpr double kAmbiguousShare = 0.75;

// A pose with the arrangement of objects that is seen from it.
struct Place {
  PoseEstimate estimate;
  Arrangement arrangement;

  double Score() const {
    return estimate.inliers + PoseEstimate::kLandmarksPerObject * arrangement.Score();
  }
};

// The steps of relocalisation by the objects of one island for one frame.
class Finder {
 public:
  Finder(const Frame& frame, const Map& map, const TrackingContext& context, IslandId island)
      : frame_(frame), map_(map), context_(context), island_(island) {}

  std::optional<PoseEstimate> Run() const {
    std::vector<Place> places = RefineHypotheses();
    const double best_score = BestScore(places);
    std::erase_if(places, [&](const Place& place) {
      return place.arrangement.matched < context_.objects.pose.min_objects ||
             place.arrangement.Score() < kWorthyShare * best_score;
    });
    for (Place& place : places) {
      AddLandmarks(place);
    }
    const Place* const best = FindBest(places);
    if (best == nullptr || !IsConfirmed(*best)) {
      return std::nullopt;
    }
    return best->estimate;
  }

 private:
  Arrangement Compare(const Rigid3& cam_from_world) const {
    return CompareArrangement(map_, context_.object_index, context_.sensor, frame_, cam_from_world,
                              island_, context_.objects);
  }

  // The hypotheses, those whose projected ellipses agree best with the hulls first.
  std::vector<Place> CompareHypotheses() const {
    std::vector<Place> places;
    for (const PoseHypothesis& hypothesis :
         ProposePoses(map_, context_.sensor.camera, frame_, island_)) {
      Place& place = places.emplace_back();
      place.estimate.cam_from_world = hypothesis.cam_from_world;
      place.arrangement = Compare(hypothesis.cam_from_world);
    }
    std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
      return a.arrangement.Score() > b.arrangement.Score();
    });
    return places;
  }

  static double BestScore(const std::vector<Place>& places) {
    double best = 0.0;
    for (const Place& place : places) {
      best = std::max(best, place.arrangement.Score());
    }
    return best;
  }

  // The hypotheses, refined by objects alone, without those that are near a better one or much
  // worse.
  std::vector<Place> RefineHypotheses() const {
    std::vector<Place> places;
    for (Place& place : CompareHypotheses()) {
      const auto is_known = [&](const Place& other) { return AreSame(other, place); };
      if (places.size() == kMostRefined ||
          place.arrangement.Score() < kWorthyShare * BestScore(places)) {
        break;  // those that follow are not better
      }
      if (std::none_of(places.begin(), places.end(), is_known)) {
        RefineByObjects(place);
        places.push_back(std::move(place));
      }
    }
    return places;
  }

  // The pose that the hull lines of the matched objects and the landmarks of the estimate explain.
  PoseEstimate Refine(const Place& place, PoseEstimate estimate) const {
    const PoseObjects objects =
        MakePoseObjects(map_, context_.sensor, frame_, estimate.cam_from_world,
                        place.arrangement.objects, context_.objects);
    return RefinePose(frame_, map_, context_, objects.objects, std::move(estimate));
  }

  void RefineByObjects(Place& place) const {
    place.estimate.landmarks.resize(frame_.features.size());
    for (int round = 0; round < kRounds; ++round) {
      place.estimate = Refine(place, std::move(place.estimate));
      place.arrangement = Compare(place.estimate.cam_from_world);
    }
  }

  // The keyframes that observe most of the matched objects, the best one first.
  std::vector<KeyframeId> ObserversOf(const Arrangement& arrangement) const {
    IdMap<KeyframeId, int> counts;
    for (const ObjectId id : arrangement.objects) {
      if (id.IsValid()) {
        for (const ObjectObservation& observation : map_.objects().At(id).observations) {
          ++counts[observation.keyframe];
        }
      }
    }
    std::vector<std::pair<int, KeyframeId>> sorted;
    for (const auto& [keyframe, count] : counts.entries()) {
      sorted.emplace_back(-count, keyframe);
    }
    std::sort(sorted.begin(), sorted.end());
    sorted.resize(std::min(sorted.size(), kMostObservers));
    std::vector<KeyframeId> observers;
    for (const auto& [count, keyframe] : sorted) {
      observers.push_back(keyframe);
    }
    return observers;
  }

  // Landmarks near the places where the rough pose expects them. Many of them may be wrong.
  std::vector<FoundLandmark> SearchWidely(const Rigid3& cam_from_world,
                                          const std::vector<LandmarkId>& landmarks) const {
    std::vector<Projection> projections;
    std::vector<LandmarkId> ids;
    for (const LandmarkId id : landmarks) {
      const Landmark& landmark = map_.landmarks().At(id);
      const auto view = ViewLandmark(context_.sensor, cam_from_world, landmark);
      if (!view) {
        continue;
      }
      Projection& projection = projections.emplace_back();
      projection.pixel = view->pixel.cast<float>();
      projection.radius =
          kWideRadius * context_.sensor.levels.scale[static_cast<size_t>(view->level)];
      projection.min_level = view->level - 1;
      projection.max_level = view->level + 1;
      projection.descriptor = landmark.descriptor;
      ids.push_back(id);
    }
    std::vector<FoundLandmark> found;
    for (const Match& match :
         MatchByProjection(frame_.features, projections, {}, {.max_ratio = kWideRatio})) {
      found.push_back({match.keypoint, ids[match.query]});
    }
    return found;
  }

  // The pose of the landmarks alone, if enough of them agree with one that is near the pose of the
  // objects.
  std::optional<PoseEstimate> PoseOf(const std::vector<FoundLandmark>& found,
                                     const Place& place) const {
    std::vector<PoseObservation> observations;
    for (const auto& [keypoint, landmark] : found) {
      observations.push_back({.point = map_.landmarks().At(landmark).position,
                              .measurement = MeasurePoint(context_.sensor, frame_.features,
                                                          keypoint, context_.sensor.depth_error)});
    }
    RansacOptions ransac;
    ransac.seed = HashSeed(context_.seed, frame_.id.value, "relocalisation by objects");
    ransac.min_inliers = static_cast<size_t>(context_.min_start_inliers());
    ransac.max_iterations = kMostSamples;
    const AbsolutePose pose = EstimateAbsolutePose(context_.sensor.camera, observations, ransac);
    if (!pose.ok() ||
        !AreSamePlace(place.estimate.cam_from_world, pose.cam_from_world, MeanDistance(place))) {
      return std::nullopt;
    }
    PoseEstimate estimate;
    estimate.cam_from_world = pose.cam_from_world;
    estimate.landmarks.resize(frame_.features.size());
    for (const size_t inlier : pose.inliers) {
      estimate.landmarks[found[inlier].keypoint] = found[inlier].landmark;
    }
    return estimate;
  }

  // Of the matched objects from the camera, m; 0 if there are none.
  double MeanDistance(const Place& place) const {
    double sum = 0.0;
    for (const ObjectId id : place.arrangement.objects) {
      if (id.IsValid()) {
        const Ellipsoid& ellipsoid = map_.objects().At(id).ellipsoid;
        sum += (place.estimate.cam_from_world * ellipsoid.world_from_object.translation).norm();
      }
    }
    return sum / std::max(1, place.arrangement.matched);
  }

  bool AreSame(const Place& a, const Place& b) const {
    return AreSamePlace(a.estimate.cam_from_world, b.estimate.cam_from_world, MeanDistance(a));
  }

  // Searches landmarks of the keyframes that observe the objects, and refines the pose with both.
  void AddLandmarks(Place& place) const {
    const std::vector<KeyframeId> observers = ObserversOf(place.arrangement);
    place.estimate.place = observers.front();
    const std::vector<LandmarkId> landmarks = ObservedLandmarks(map_, observers);
    if (auto estimate = PoseOf(SearchWidely(place.estimate.cam_from_world, landmarks), place)) {
      estimate->place = place.estimate.place;
      place.estimate = Refine(place, std::move(*estimate));
      place.arrangement = Compare(place.estimate.cam_from_world);
    }
    std::vector<LandmarkId>& known = place.estimate.landmarks;
    std::fill(known.begin(), known.end(), LandmarkId());
    for (const auto& [keypoint, landmark] :
         FindLandmarks(map_, context_.sensor, frame_, place.estimate.cam_from_world, landmarks)) {
      known[keypoint] = landmark;
    }
    place.estimate = Refine(place, std::move(place.estimate));
    place.arrangement = Compare(place.estimate.cam_from_world);
  }

  // The place with the best score. Null if there is none, or if another one is about as good.
  const Place* FindBest(const std::vector<Place>& places) const {
    const Place* best = nullptr;
    for (const Place& place : places) {
      if (best == nullptr || place.Score() > best->Score()) {
        best = &place;
      }
    }
    const bool is_ambiguous =
        best != nullptr && std::any_of(places.begin(), places.end(), [&](const Place& other) {
          return other.Score() >= kAmbiguousShare * best->Score() && !AreSame(*best, other);
        });
    return is_ambiguous ? nullptr : best;
  }

  // Enough landmarks or enough objects agree with the pose.
  bool IsConfirmed(const Place& place) const {
    const Arrangement& arrangement = place.arrangement;
    const bool do_objects_agree =
        arrangement.Score() > 0.0 && arrangement.overlap >= kLeastMeanOverlap * arrangement.matched;
    return do_objects_agree && place.estimate.EffectiveInliers() >= context_.options.min_inliers;
  }

  const Frame& frame_;
  const Map& map_;
  const TrackingContext& context_;
  const IslandId island_;
};

}  // namespace

std::optional<PoseEstimate> PoseByObjects(const Frame& frame, const Map& map,
                                          const TrackingContext& context,
                                          const LastFrame& /*last*/) {
  const bool is_wanted = context.options.relocalise_by_objects && context.objects.enabled;
  if (!is_wanted || frame.detections.size() < 2 || map.objects().empty()) {
    return std::nullopt;
  }
  std::optional<PoseEstimate> best;
  for (const IslandId island : Islands(map)) {
    std::optional<PoseEstimate> found = Finder(frame, map, context, island).Run();
    if (found && (!best || found->EffectiveInliers() > best->EffectiveInliers())) {
      best = std::move(found);
    }
  }
  return best;
}

}  // namespace hullslam
