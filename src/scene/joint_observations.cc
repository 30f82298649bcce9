// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/joint_observations.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "geometry/polygon.h"
#include "hullslam/geometry/dual_quadric.h"

namespace hullslam {
namespace {

constexpr double kInside = 0.8;        // least share of a hull that is inside another one
constexpr double kHiddenShare = 0.25;  // least share of an ellipse that is hidden
constexpr double kAcross = 0.5;        // least common share of the narrower of two boxes
constexpr int kCorners = 32;           // of the polygon of an ellipse

// A mapped object in one image.
struct SeenObject {
  ObjectId id;
  const Detection* detection = nullptr;  // null if the keyframe does not observe it
  double depth = 0.0;                    // of the centre, along z
  double reach = 0.0;                    // half extent along z
  std::vector<Eigen::Vector2d> outline;  // of the projected ellipse
  Eigen::AlignedBox2d box;               // of the projected ellipse
};

// Nothing unless the ellipsoid is in front of the camera and its centre is in the image.
std::optional<SeenObject> Project(ObjectId id, const ObjectLandmark& object,
                                  const Keyframe& keyframe, const PinholeCamera& camera,
                                  const PinholeCamera::Bounds& bounds) {
  const auto ellipse = ProjectEllipsoid(camera.Matrix(), keyframe.cam_from_world, object.ellipsoid);
  if (!ellipse || !bounds.Contains(ellipse->center)) {
    return std::nullopt;
  }
  const Rigid3 cam_from_object = keyframe.cam_from_world * object.ellipsoid.world_from_object;
  SeenObject seen;
  seen.id = id;
  seen.depth = cam_from_object.translation.z();
  const Eigen::Vector3d forward = cam_from_object.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  seen.reach = object.ellipsoid.half_axes.cwiseProduct(forward).norm();
  seen.outline = ellipse->Polygon(kCorners);
  seen.box = ellipse->Bounds();
  return seen;
}

// The mapped objects in the image of a keyframe, whether it observes them or not.
std::vector<SeenObject> ObjectsIn(const Map& map, const Keyframe& keyframe,
                                  const PinholeCamera& camera) {
  const PinholeCamera::Bounds bounds = camera.UndistortedBounds();
  std::vector<SeenObject> all;
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    if (object.state != ObjectState::kMapped) {
      return;
    }
    auto seen = Project(id, object, keyframe, camera, bounds);
    if (!seen) {
      return;
    }
    const auto found = std::find(keyframe.objects.begin(), keyframe.objects.end(), id);
    if (found != keyframe.objects.end()) {
      seen->detection =
          &keyframe.frame->detections[static_cast<size_t>(found - keyframe.objects.begin())];
    }
    all.push_back(std::move(*seen));
  });
  return all;
}

// Whether A is nearer than B as a whole: its centre is before the near side of B's middle half.
bool IsNearer(const SeenObject& a, const SeenObject& b) {
  return a.depth < b.depth - 0.5 * b.reach && a.depth + 0.5 * a.reach < b.depth;
}

bool IsAcross(const SeenObject& a, const SeenObject& b) {
  const double common =
      std::min(a.box.max().x(), b.box.max().x()) - std::max(a.box.min().x(), b.box.min().x());
  return common >= kAcross * std::min(a.box.sizes().x(), b.box.sizes().x());
}

bool IsMaskInside(const SeenObject& a, const SeenObject& b) {
  const double area = SignedArea(a.detection->hull);
  return area > 0.0 && IntersectionArea(a.detection->hull, b.detection->hull) >= kInside * area;
}

void CountPair(const SeenObject& a, const SeenObject& b, ObservationStatistics& statistics) {
  if (a.detection != nullptr && b.detection != nullptr) {
    JointObservations& joint = statistics.joint[{a.id, b.id}];
    ++joint.observations;
    joint.in_front += IsNearer(a, b) && IsAcross(a, b) ? 1 : 0;
    joint.mask_inside += IsMaskInside(a, b) ? 1 : 0;
  }
  if (a.detection != nullptr || b.detection != nullptr) {
    const bool is_behind = IsNearer(b, a) && a.box.intersects(b.box);
    const double share =
        is_behind ? IntersectionArea(a.outline, b.outline) / SignedArea(a.outline) : 0.0;
    HiddenCounts& hidden = statistics.hidden[{a.id, b.id}];
    ++hidden.observations;
    hidden.hidden += share >= kHiddenShare ? 1 : 0;
    hidden.most = std::max(hidden.most, std::min(1.0, share));
  }
}

}  // namespace

const JointObservations& ObservationStatistics::Joint(ObjectId a, ObjectId b) const {
  static const JointObservations none;
  const auto found = joint.find({a, b});
  return found == joint.end() ? none : found->second;
}

ObservationStatistics CollectObservationStatistics(const Map& map, const PinholeCamera& camera) {
  ObservationStatistics statistics;
  map.keyframes().ForEach([&](KeyframeId, const Keyframe& keyframe) {
    const std::vector<SeenObject> seen = ObjectsIn(map, keyframe, camera);
    for (const SeenObject& a : seen) {
      for (const SeenObject& b : seen) {
        if (a.id != b.id) {
          CountPair(a, b, statistics);
        }
      }
    }
  });
  return statistics;
}

}  // namespace hullslam
