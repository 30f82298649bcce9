// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/repeated_views.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "geometry/polygon.h"
#include "map/islands.h"
#include "objects/constraint/point_statistics.h"
#include "objects/visibility.h"
#include "tracking/last_frame.h"
#include "util/id_set.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

// A join needs two keyframes of one place. The second two are for what a single one may miss.
constexpr int kMostRequests = 4;
// Two images show the same view if each of them has at least this share of the landmarks of the
// other one (a camera that turns by a tenth of its field of view sees another one), and if the
// distance between the cameras is less than this share of the median depth: 10 degrees.
constexpr double kSameLandmarks = 0.9;
constexpr double kSameDirection = 0.18;

// The median depth of the landmarks that the map has; 0 if there are none.
double MedianDepth(const Map& map, const Rigid3& cam_from_world,
                   const std::vector<LandmarkId>& landmarks) {
  std::vector<double> depths;
  for (const LandmarkId id : landmarks) {
    if (const Landmark* const landmark = map.landmarks().Find(id)) {
      depths.push_back((cam_from_world * landmark->position).z());
    }
  }
  return depths.empty() ? 0.0 : Median(std::move(depths));
}

// What was seen a moment ago is mapped better by a second look; a lap of a room takes longer.
constexpr double kLeastTime = 30.0;   // s
constexpr double kMostShift = 0.04;   // of the width of the image; half of it lies between
                                      // keyframes of a hand that moves at 0.25 m/s
constexpr double kMostZoom = 0.1;     // logarithm of the ratio of distances
constexpr double kLeastFound = 0.25;  // of its landmarks; fewer if the light has changed
constexpr size_t kPoints = 40;        // that are compared

// The landmarks of a frame with some of their positions in its camera.
struct View {
  IdSet<LandmarkId> landmarks;
  std::vector<Eigen::Vector3d> points;
};

View ViewOf(const Map& map, const PoseEstimate& estimate) {
  std::vector<LandmarkId> found;
  for (const LandmarkId id : estimate.landmarks) {
    if (id.IsValid() && map.landmarks().Contains(id)) {
      found.push_back(id);
    }
  }
  View view;
  const size_t step = std::max<size_t>(1, found.size() / kPoints);
  for (size_t i = 0; i < found.size(); ++i) {
    view.landmarks.Insert(found[i]);
    if (i % step == 0) {
      view.points.push_back(estimate.cam_from_world * map.landmarks().At(found[i]).position);
    }
  }
  return view;
}

bool ShowsTheSame(const View& view, const Keyframe& keyframe, const Rigid3& keyframe_from_frame,
                  double most_angle) {
  const auto is_near = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d other = keyframe_from_frame * point;
    return std::abs(std::log(other.norm() / point.norm())) < kMostZoom &&
           std::atan2(point.cross(other).norm(), point.dot(other)) < most_angle;
  };
  const auto near = std::ranges::count_if(view.points, is_near);
  if (2 * static_cast<size_t>(near) <= view.points.size()) {
    return false;
  }
  size_t landmarks = 0;
  size_t found = 0;
  for (const LandmarkId id : keyframe.landmarks) {
    landmarks += id.IsValid() ? 1 : 0;
    found += id.IsValid() && view.landmarks.Contains(id) ? 1 : 0;
  }
  return static_cast<double>(found) >= kLeastFound * static_cast<double>(landmarks);
}

constexpr double kMatureTime = 60.0;  // s
constexpr int kMatureViews = 3;
constexpr double kSimilarAngle = 0.26;  // rad, between two directions to a point: 15 degrees
constexpr double kSimilarZoom = 0.35;   // logarithm of the ratio of distances
// A keyframe is redundant if this share of its landmarks is seen by so many others (CullKeyframes).
constexpr double kRedundantShare = 0.9;
constexpr int kOtherObservers = 4;

// Whether a keyframe shows most of the points from a similar direction and distance.
bool ShowsSimilarly(const Sensor& sensor, const View& view, const Rigid3& keyframe_from_frame) {
  const Eigen::Vector3d camera = keyframe_from_frame.translation;
  const auto is_similar = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d there = keyframe_from_frame * point;
    const Eigen::Vector3d ray = there - camera;
    return there.z() > 0.0 && std::abs(std::log(there.norm() / point.norm())) < kSimilarZoom &&
           std::atan2(there.cross(ray).norm(), there.dot(ray)) < kSimilarAngle &&
           sensor.bounds.Contains(sensor.camera.Project(there));
  };
  return 2 * std::ranges::count_if(view.points, is_similar) >
         static_cast<std::ptrdiff_t>(view.points.size());
}

// Whether at most one part of the image is new: of its keypoints, fewer than a tenth show
// landmarks, also if it had eight fewer.
bool CoversTheImage(const Sensor& sensor, const Frame& frame,
                    const std::vector<LandmarkId>& landmarks) {
  std::array<int, 12> surplus{};  // by part, of landmarks times ten over keypoints
  const PinholeCamera::Bounds& bounds = sensor.bounds;
  for (size_t i = 0; i < landmarks.size(); ++i) {
    const Eigen::Vector2d pixel = frame.features.keypoints[i].undistorted.cast<double>();
    const double x = (pixel.x() - bounds.min_x) / (bounds.max_x - bounds.min_x);
    const double y = (pixel.y() - bounds.min_y) / (bounds.max_y - bounds.min_y);
    const int column = std::clamp(static_cast<int>(4.0 * x), 0, 3);
    const int row = std::clamp(static_cast<int>(3.0 * y), 0, 2);
    surplus[static_cast<size_t>(4 * row + column)] += landmarks[i].IsValid() ? 9 : -1;
  }
  return std::ranges::count_if(surplus, [](int of_part) { return of_part < -8; }) <= 1;
}

constexpr int kLastingFrames = 10;
constexpr int kMostMissed = 2;
constexpr double kSamePlace = 0.12;  // of the distance to the camera: 7 degrees
// A new object is mapped, and one that is gone removed, with three keyframes, if all goes well.
constexpr int kMostChangeRequests = 8;
constexpr double kPlaceMemory = 1800.0;  // s; then a place may ask again
constexpr double kLeastOverlap = 0.4;    // intersection over union of the boxes in two frames

// Where a detection is: the mean of its depth points, or at the median depth of the landmarks.
Eigen::Vector3d PositionOf(const Detection& detection, const Map& map, const Sensor& sensor,
                           const PoseEstimate& estimate) {
  const Rigid3 world_from_cam = Inverse(estimate.cam_from_world);
  if (detection.points.empty()) {
    const double depth = MedianDepth(map, estimate.cam_from_world, estimate.landmarks);
    return world_from_cam * sensor.camera.Unproject(detection.box.center(), depth);
  }
  return world_from_cam * MeanOf(detection.points.Unpack());
}

}  // namespace

bool JoinRequests::MayAskAgain(const Map& map, const Sensor& sensor, KeyframeId reference,
                               const PoseEstimate& estimate) {
  if (requests_ > 0 && !IsSameView(map, sensor, reference, estimate)) {
    requests_ = 0;
  }
  return requests_ < kMostRequests;
}

void JoinRequests::Add(const Map& map, KeyframeId reference, const PoseEstimate& estimate) {
  if (requests_++ == 0) {
    pose_ = map.RelativeTo(reference, estimate.cam_from_world);
    landmarks_ = estimate.landmarks;
  }
}

bool JoinRequests::IsSameView(const Map& map, const Sensor& sensor, KeyframeId reference,
                              const PoseEstimate& estimate) const {
  if (!map.NearestAlive(pose_.reference).IsValid() ||
      IslandOf(map, pose_.reference) != IslandOf(map, reference)) {
    return false;
  }
  std::vector<LandmarkId> then = landmarks_;
  std::ranges::transform(then, then.begin(), [&](LandmarkId id) { return map.Resolve(id); });
  const Rigid3 pose_then = map.CamFromWorld(pose_);
  const Rigid3& pose = estimate.cam_from_world;
  const double distance = (Inverse(pose).translation - Inverse(pose_then).translation).norm();
  return ShareInImage(map, sensor, pose, then) >= kSameLandmarks &&
         ShareInImage(map, sensor, pose_then, estimate.landmarks) >= kSameLandmarks &&
         distance <= kSameDirection * MedianDepth(map, pose, estimate.landmarks);
}

bool IsKnownView(const Map& map, const Sensor& sensor, const Frame& frame, FrameId first_of_session,
                 KeyframeId reference, const PoseEstimate& estimate) {
  const View view = ViewOf(map, estimate);
  const Rigid3 world_from_cam = Inverse(estimate.cam_from_world);
  const double most_angle = kMostShift * sensor.camera.width / sensor.camera.fx;
  const auto is_known = [&](KeyframeId id) {
    const Keyframe& keyframe = map.keyframes().At(id);
    return keyframe.frame->id >= first_of_session &&
           frame.timestamp - keyframe.frame->timestamp > kLeastTime &&
           ShowsTheSame(view, keyframe, keyframe.cam_from_world * world_from_cam, most_angle);
  };
  const std::vector<Covisible>& covisible = map.keyframes().At(reference).covisible;
  return is_known(reference) || std::ranges::any_of(covisible, [&](const Covisible& other) {
           return is_known(other.keyframe);
         });
}

bool IsWellMapped(const Map& map, const Sensor& sensor, const Frame& frame,
                  FrameId first_of_session, const LocalTracking& tracking) {
  const PoseEstimate& estimate = tracking.estimate;
  if (2 * static_cast<size_t>(estimate.inliers) < tracking.visible.size() ||
      !CoversTheImage(sensor, frame, estimate.landmarks)) {
    return false;
  }
  const auto is_old = [&](KeyframeId id) {
    const Frame& other = *map.keyframes().At(id).frame;
    return other.id >= first_of_session && frame.timestamp - other.timestamp > kMatureTime;
  };
  const View view = ViewOf(map, estimate);
  const Rigid3 world_from_cam = Inverse(estimate.cam_from_world);
  const auto is_similar = [&](KeyframeId id) {
    const Rigid3& cam_from_world = map.keyframes().At(id).cam_from_world;
    return is_old(id) && ShowsSimilarly(sensor, view, cam_from_world * world_from_cam);
  };
  int similar = is_similar(tracking.reference) ? 1 : 0;
  for (const Covisible& other : map.keyframes().At(tracking.reference).covisible) {
    similar += similar < kMatureViews && is_similar(other.keyframe) ? 1 : 0;
  }
  if (similar == 0 || similar >= kMatureViews) {
    return similar > 0;
  }
  int found = 0;
  int redundant = 0;
  for (const LandmarkId id : estimate.landmarks) {
    const Landmark* const landmark = id.IsValid() ? map.landmarks().Find(id) : nullptr;
    if (landmark != nullptr) {
      ++found;
      const auto observers =
          std::ranges::count_if(landmark->observations, is_old, &Observation::keyframe);
      redundant += observers >= kOtherObservers ? 1 : 0;
    }
  }
  return redundant >= kRedundantShare * found;
}

int LastingChanges::Follow(const Frame& frame, const Map& map, const TrackingContext& context,
                           const LocalTracking& tracking) {
  const Rigid3& cam_from_world = tracking.estimate.cam_from_world;
  camera_ = Inverse(cam_from_world).translation;
  time_ = frame.timestamp;
  std::erase_if(places_, [&](const Place& place) { return time_ - place.time > kPlaceMemory; });
  for (Change& change : changes_) {
    ++change.missed;
  }
  for (size_t i = 0; i < tracking.objects.size(); ++i) {
    if (!tracking.objects[i].IsValid()) {
      const Detection& detection = frame.detections[i];
      Note({.gone = {},
            .label = detection.label,
            .box = detection.box,
            .position = PositionOf(detection, map, context.sensor, tracking.estimate)});
    }
  }
  for (const ObjectId id : map.keyframes().At(tracking.reference).objects) {
    const ObjectLandmark* const object = id.IsValid() ? map.objects().Find(id) : nullptr;
    if (object != nullptr && object->state == ObjectState::kMapped &&
        std::ranges::find(tracking.objects, id) == tracking.objects.end() &&
        SeesThrough(context.sensor, frame, cam_from_world, object->ellipsoid,
                    context.objects.changes.min_seen_through)) {
      Note({.gone = id,
            .label = {},
            .box = {},
            .position = object->ellipsoid.world_from_object.translation});
    }
  }
  std::erase_if(changes_, [](const Change& change) { return change.missed > kMostMissed; });
  return static_cast<int>(
      std::ranges::count_if(changes_, [&](const Change& change) { return IsReason(change); }));
}

void LastingChanges::Note(const Change& change) {
  const auto known = std::ranges::find_if(changes_, [&](const Change& other) {
    return other.missed > 0 && other.gone == change.gone && other.label == change.label &&
           (change.gone.IsValid() || IntersectionOverUnion(other.box, change.box) >= kLeastOverlap);
  });
  const int seen = known != changes_.end() ? known->seen : 0;
  Change& noted = known != changes_.end() ? *known : changes_.emplace_back();
  noted = change;
  noted.seen = seen + 1;
}

LastingChanges::Place* LastingChanges::FindPlace(const Eigen::Vector3d& position) {
  const double radius = kSamePlace * (position - camera_).norm();
  const auto place = std::ranges::find_if(
      places_, [&](const Place& other) { return (other.position - position).norm() < radius; });
  return place != places_.end() ? &*place : nullptr;
}

bool LastingChanges::IsReason(const Change& change) {
  const Place* const place = FindPlace(change.position);
  return change.seen >= kLastingFrames && change.missed == 0 &&
         (place == nullptr || place->requests < kMostChangeRequests);
}

bool LastingChanges::IsBeingLearnt() {
  return std::ranges::any_of(changes_, [&](const Change& change) {
    return IsReason(change) && FindPlace(change.position) != nullptr;
  });
}

void LastingChanges::NoteRequest() {
  for (const Change& change : changes_) {
    if (IsReason(change)) {
      Place* const known = FindPlace(change.position);
      Place& place = known != nullptr ? *known : places_.emplace_back();
      place = {change.position, place.requests + 1, time_};
    }
  }
}

}  // namespace hullslam
