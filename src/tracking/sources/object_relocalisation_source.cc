// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "estimators/absolute_pose.h"
#include "frame/measure_point.h"
#include "map/islands.h"
#include "map/keyframe_graph.h"
#include "map/landmark_projection.h"
#include "matching/by_projection.h"
#include "objects/arrangement.h"
#include "objects/pose_hypotheses.h"
#include "places/landmark_search.h"
#include "tracking/frame_objects.h"
#include "tracking/pose_refinement.h"
#include "tracking/sources/pose_source.h"
#include "util/hash.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

constexpr size_t kMostRefined = 6;     // number of hypotheses that are refined
constexpr size_t kMostObservers = 30;  // number of keyframes whose landmarks are searched
constexpr int kRounds = 2;             // rounds of matching and refinement with objects alone
constexpr float kWideRadius = 25.0f;   // px at level 0; poses from objects err by centimetres
constexpr double kWideRatio = 0.8;
constexpr double kLeastMeanOverlap = 0.5;  // least mean overlap of the objects that confirm a pose
// Hypotheses with a smaller share of the best score of objects are dropped.
constexpr double kWorthyShare = 0.5;
constexpr int kMostSamples = 200;  // of RANSAC; most landmarks agree with a true pose
// If a second candidate reaches this share of the best score, the frame is ambiguous.
constexpr double kAmbiguousShare = 0.75;

// A pose with the arrangement of objects that is seen from it.
struct Candidate {
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
    std::vector<Candidate> candidates = RefineHypotheses();
    const double best_score = BestScore(candidates);
    std::erase_if(candidates, [&](const Candidate& candidate) {
      return candidate.arrangement.matched < context_.objects.pose.min_objects ||
             candidate.arrangement.Score() < kWorthyShare * best_score;
    });
    for (Candidate& candidate : candidates) {
      AddLandmarks(candidate);
    }
    const Candidate* const best = FindBest(candidates);
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
  std::vector<Candidate> CompareHypotheses() const {
    std::vector<Candidate> candidates;
    for (const PoseHypothesis& hypothesis :
         ProposePoses(map_, context_.sensor.camera, frame_, island_)) {
      Candidate& candidate = candidates.emplace_back();
      candidate.estimate.cam_from_world = hypothesis.cam_from_world;
      candidate.arrangement = Compare(hypothesis.cam_from_world);
    }
    std::ranges::stable_sort(candidates, std::greater(), [](const Candidate& candidate) {
      return candidate.arrangement.Score();
    });
    return candidates;
  }

  static double BestScore(const std::vector<Candidate>& candidates) {
    double best = 0.0;
    for (const Candidate& candidate : candidates) {
      best = std::max(best, candidate.arrangement.Score());
    }
    return best;
  }

  // Refines the hypotheses by objects alone. Hypotheses that are near a better one, or much worse
  // than the best one, are left out.
  std::vector<Candidate> RefineHypotheses() const {
    std::vector<Candidate> candidates;
    for (Candidate& candidate : CompareHypotheses()) {
      const auto is_known = [&](const Candidate& other) { return AreSame(other, candidate); };
      if (candidates.size() == kMostRefined ||
          candidate.arrangement.Score() < kWorthyShare * BestScore(candidates)) {
        break;  // the hypotheses are sorted, so those that follow are not better
      }
      if (std::none_of(candidates.begin(), candidates.end(), is_known)) {
        RefineByObjects(candidate);
        candidates.push_back(std::move(candidate));
      }
    }
    return candidates;
  }

  // The pose that fits the hull lines of the matched objects and the landmarks of `estimate` best.
  PoseEstimate Refine(const Candidate& candidate, PoseEstimate estimate) const {
    const PoseObjects objects =
        MakePoseObjects(map_, context_.sensor, frame_, estimate.cam_from_world,
                        candidate.arrangement.objects, context_.objects);
    return RefinePose(frame_, map_, context_, objects.objects, std::move(estimate));
  }

  void RefineByObjects(Candidate& candidate) const {
    candidate.estimate.landmarks.resize(frame_.features.size());
    for (int round = 0; round < kRounds; ++round) {
      candidate.estimate = Refine(candidate, std::move(candidate.estimate));
      candidate.arrangement = Compare(candidate.estimate.cam_from_world);
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

  // Landmarks near the pixels where the rough pose expects them. Many of them may be wrong.
  std::vector<FoundLandmark> SearchWidely(const Rigid3& cam_from_world,
                                          const std::vector<LandmarkId>& landmarks) const {
    std::vector<Projection> projections;
    std::vector<LandmarkId> ids;
    for (const LandmarkId id : landmarks) {
      const Landmark& landmark = map_.landmarks().At(id);
      const auto view = ProjectLandmark(context_.sensor, cam_from_world, landmark);
      if (!view) {
        continue;
      }
      Projection& projection = projections.emplace_back();
      projection.pixel = view->raw_pixel.cast<float>();
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

  // The pose from the landmarks alone, if enough of them agree with it and it is near the pose from
  // the objects.
  std::optional<PoseEstimate> PoseOf(const std::vector<FoundLandmark>& found,
                                     const Candidate& candidate) const {
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
    if (!pose.ok() || !AreSamePlace(candidate.estimate.cam_from_world, pose.cam_from_world,
                                    MeanDistance(candidate))) {
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

  // Mean distance of the matched objects from the camera, m; 0 if there are none.
  double MeanDistance(const Candidate& candidate) const {
    double sum = 0.0;
    for (const ObjectId id : candidate.arrangement.objects) {
      if (id.IsValid()) {
        const Ellipsoid& ellipsoid = map_.objects().At(id).ellipsoid;
        sum += (candidate.estimate.cam_from_world * ellipsoid.world_from_object.translation).norm();
      }
    }
    return sum / std::max(1, candidate.arrangement.matched);
  }

  bool AreSame(const Candidate& a, const Candidate& b) const {
    return AreSamePlace(a.estimate.cam_from_world, b.estimate.cam_from_world, MeanDistance(a));
  }

  // Searches landmarks of the keyframes that observe the objects, and refines the pose with objects
  // and landmarks.
  void AddLandmarks(Candidate& candidate) const {
    const std::vector<KeyframeId> observers = ObserversOf(candidate.arrangement);
    candidate.estimate.keyframe_of_place = observers.front();
    const std::vector<LandmarkId> landmarks = ObservedLandmarks(map_, observers);
    if (auto estimate =
            PoseOf(SearchWidely(candidate.estimate.cam_from_world, landmarks), candidate)) {
      estimate->keyframe_of_place = candidate.estimate.keyframe_of_place;
      candidate.estimate = Refine(candidate, std::move(*estimate));
      candidate.arrangement = Compare(candidate.estimate.cam_from_world);
    }
    std::vector<LandmarkId>& known = candidate.estimate.landmarks;
    std::fill(known.begin(), known.end(), LandmarkId());
    for (const auto& [keypoint, landmark] : FindLandmarks(
             map_, context_.sensor, frame_, candidate.estimate.cam_from_world, landmarks)) {
      known[keypoint] = landmark;
    }
    candidate.estimate = Refine(candidate, std::move(candidate.estimate));
    candidate.arrangement = Compare(candidate.estimate.cam_from_world);
  }

  // The candidate with the best score. Null if there is none, or if another place is about as good.
  const Candidate* FindBest(const std::vector<Candidate>& candidates) const {
    const auto best = std::ranges::max_element(candidates, {}, &Candidate::Score);
    const auto is_rival = [&](const Candidate& other) {
      return other.Score() >= kAmbiguousShare * best->Score() && !AreSame(*best, other);
    };
    return candidates.empty() || std::ranges::any_of(candidates, is_rival) ? nullptr : &*best;
  }

  // Whether enough landmarks or enough objects agree with the pose.
  bool IsConfirmed(const Candidate& candidate) const {
    const Arrangement& arrangement = candidate.arrangement;
    const bool do_objects_agree =
        arrangement.Score() > 0.0 && arrangement.overlap >= kLeastMeanOverlap * arrangement.matched;
    return do_objects_agree &&
           candidate.estimate.EffectiveInliers() >= context_.options.min_inliers;
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
  // In equal rooms objects that were moved since would decide.
  const bool has_rival = best && best->median_depth > 0.0 &&
                         HasRival(frame, map, context, best->keyframe_of_place, *best);
  return has_rival ? std::nullopt : best;
}

}  // namespace hullslam
