// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/local_map_tracking.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "map/islands.h"
#include "map/keyframe_graph.h"
#include "map/landmark_projection.h"
#include "matching/by_projection.h"
#include "tracking/frame_objects.h"
#include "tracking/pose_refinement.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

constexpr size_t kNeighbours = 10;

// A set of keyframes that keeps the order in which they were added.
class KeyframeSet {
 public:
  explicit KeyframeSet(size_t capacity) : capacity_(capacity) {}
  void Add(KeyframeId id) {
    if (id.IsValid() && !IsFull() && ids_.Insert(id)) {
      members_.push_back(id);
    }
  }
  bool IsFull() const { return members_.size() >= capacity_; }
  const std::vector<KeyframeId>& members() const { return members_; }

 private:
  IdSet<KeyframeId> ids_;
  std::vector<KeyframeId> members_;
  size_t capacity_;
};

void AddNeighbours(const Map& map, KeyframeSet& set) {
  const std::vector<KeyframeId> observers = set.members();
  for (const KeyframeId id : observers) {
    if (set.IsFull()) {
      return;
    }
    const Keyframe& keyframe = map.keyframes().At(id);
    for (const KeyframeId neighbour : BestCovisible(keyframe, kNeighbours)) {
      set.Add(neighbour);
    }
    for (const KeyframeId child : keyframe.children) {
      set.Add(child);
    }
    set.Add(keyframe.parent);
  }
}

}  // namespace

LocalMap SelectLocalMap(const Map& map, std::span<const LandmarkId> landmarks,
                        KeyframeId last_reference, size_t max_keyframes) {
  std::vector<Covisible> observers = CountObservers(map, landmarks);
  if (observers.empty()) {
    observers.push_back({last_reference, 0});
  }
  KeyframeSet set(max_keyframes);
  for (const Covisible& observer : observers) {
    set.Add(observer.keyframe);
  }
  AddNeighbours(map, set);
  LocalMap local;
  local.reference = observers.front().keyframe;
  local.keyframes = set.members();
  std::sort(local.keyframes.begin(), local.keyframes.end());
  local.landmarks = ObservedLandmarks(map, local.keyframes);
  return local;
}

namespace {

// A landmark that is seen from its mean direction is searched within a smaller radius (Mur-Artal
// and Tardos 2017).
constexpr double kFrontalShare = 2.5 / 4.0;
constexpr double kCosFrontal = 0.998;

// The search window of a landmark. Null if the camera cannot recognise it (ProjectLandmark).
std::optional<Projection> ExpectLandmark(const Sensor& sensor, const MatrixPose& cam_from_world,
                                         const Landmark& landmark) {
  const std::optional<LandmarkProjection> view = ProjectLandmark(sensor, cam_from_world, landmark);
  if (!view) {
    return std::nullopt;
  }
  const double radius = kLocalSearchRadius * (view->cos_view > kCosFrontal ? kFrontalShare : 1.0);
  Projection projection;
  projection.pixel = view->raw_pixel.cast<float>();
  projection.radius =
      static_cast<float>(radius) * sensor.levels.scale[static_cast<size_t>(view->level)];
  projection.ExpectDepth(view->point_in_cam.z(), sensor.camera.bf);
  projection.min_level = view->level - 1;
  projection.max_level = view->level;
  projection.descriptor = landmark.descriptor;
  return projection;
}

// The search for landmarks in one frame from one pose. A landmark that was searched once is not
// searched again.
class LandmarkSearch {
 public:
  // The landmarks of the estimate count as searched.
  LandmarkSearch(const Frame& frame, const Map& map, const Sensor& sensor,
                 const PoseEstimate& estimate)
      : frame_(frame), map_(map), sensor_(sensor), cam_from_world_(estimate.cam_from_world) {
    for (const LandmarkId id : estimate.landmarks) {
      if (id.IsValid()) {
        MarkVisible(id);
      }
    }
  }

  // Searches `candidates` at the keypoints that show no landmark yet and are not excluded
  // (`is_excluded`: one entry per keypoint, or empty). Writes the landmarks that are found into
  // `landmarks`, which has one entry per keypoint.
  void Run(std::span<const LandmarkId> candidates, std::span<const uint8_t> is_excluded,
           std::vector<LandmarkId>& landmarks) {
    std::vector<Projection> projections;
    std::vector<LandmarkId> ids;
    for (const LandmarkId id : candidates) {
      if (known_.Contains(id)) {
        continue;
      }
      if (const auto projection =
              ExpectLandmark(sensor_, cam_from_world_, map_.landmarks().At(id))) {
        MarkVisible(id);
        projections.push_back(*projection);
        ids.push_back(id);
      }
    }
    std::vector<uint8_t> taken(frame_.features.size(), 0);
    for (size_t i = 0; i < taken.size(); ++i) {
      const bool is_excluded_here = !is_excluded.empty() && is_excluded[i] != 0;
      taken[i] = is_excluded_here || landmarks[i].IsValid() ? 1 : 0;
    }
    const std::vector<Match> matches = MatchByProjection(frame_.features, projections, taken,
                                                         {.max_distance = 100, .max_ratio = 0.8});
    for (const Match& match : matches) {
      landmarks[match.keypoint] = ids[match.query];
    }
  }

  // The landmarks that were searched or found before.
  const IdSet<LandmarkId>& known() const { return known_; }
  std::vector<LandmarkId> TakeVisible() { return std::move(visible_); }

 private:
  void MarkVisible(LandmarkId id) {
    known_.Insert(id);
    visible_.push_back(id);
  }

  const Frame& frame_;
  const Map& map_;
  const Sensor& sensor_;
  const MatrixPose cam_from_world_;
  IdSet<LandmarkId> known_;
  std::vector<LandmarkId> visible_;
};

}  // namespace

LocalTracking TrackLocalMap(const Frame& frame, const Map& map, const TrackingContext& context,
                            KeyframeId last_reference, PoseEstimate start) {
  LocalTracking tracking;
  const LocalMap local = SelectLocalMap(map, start.landmarks, last_reference,
                                        static_cast<size_t>(context.options.local_keyframes));
  tracking.reference = local.reference;
  LandmarkSearch search(frame, map, context.sensor, start);
  search.Run(local.landmarks, {}, start.landmarks);
  tracking.objects = FindMappedObjects(frame, map, context, start, IslandOf(map, local.reference));
  if (context.objects.guided_matching) {
    for (const ObjectGuide& guide : GuideByObjects(map, frame, tracking.objects, search.known())) {
      search.Run(guide.landmarks, guide.is_outside, start.landmarks);
    }
  }
  tracking.visible = search.TakeVisible();
  tracking.estimate = std::move(start);
  RefineTracking(frame, map, context, tracking);
  return tracking;
}

void RefineTracking(const Frame& frame, const Map& map, const TrackingContext& context,
                    LocalTracking& tracking) {
  PoseObjects pose_objects;
  if (context.objects.joint_pose) {
    pose_objects = MakePoseObjects(map, context.sensor, frame, tracking.estimate.cam_from_world,
                                   tracking.objects, context.objects);
  }
  if (context.options.keyframes_for_objects) {
    tracking.unknown_objects =
        static_cast<int>(std::count_if(tracking.objects.begin(), tracking.objects.end(),
                                       [](ObjectId object) { return !object.IsValid(); }));
  }
  tracking.estimate =
      RefinePose(frame, map, context, pose_objects.objects, std::move(tracking.estimate));
}

}  // namespace hullslam
