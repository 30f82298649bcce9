// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/arrangement.h"

#include <algorithm>
#include <optional>
#include <span>

#include "frame/detection/visible_part.h"
#include "geometry/polygon.h"
#include "objects/object_sighting.h"
#include "objects/visibility.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

constexpr double kLeastOverlap = 0.3;
constexpr int kVertices = 32;  // number of vertices of the polygon of an ellipse

// A detection and an object that it may show.
struct Pair {
  size_t detection = 0;
  ObjectId object;
  double overlap = 0.0;
};

void AddPairs(const Frame& frame, const Sensor& sensor, const Rigid3& cam_from_world, ObjectId id,
              const ObjectLandmark& object, std::vector<Pair>& pairs) {
  const auto ellipse = ProjectEllipsoid(sensor.camera.Matrix(), cam_from_world, object.ellipsoid);
  if (!ellipse) {
    return;
  }
  const Eigen::AlignedBox2d image(Eigen::Vector2d(sensor.bounds.min_x, sensor.bounds.min_y),
                                  Eigen::Vector2d(sensor.bounds.max_x, sensor.bounds.max_y));
  const Eigen::AlignedBox2d box = ellipse->Bounds();
  std::vector<Eigen::Vector2d> polygon;
  for (size_t i = 0; i < frame.detections.size(); ++i) {
    const Detection& detection = frame.detections[i];
    if (!box.intersects(detection.box) || !MayHaveClass(object, detection.label)) {
      continue;
    }
    if (polygon.empty()) {
      polygon = VisiblePart(ellipse->Polygon(kVertices), sensor.camera, image);
    }
    const double overlap = detection.is_box ? IntersectionOverUnion(box, detection.box)
                                            : IntersectionOverUnion(polygon, detection.hull);
    if (overlap >= kLeastOverlap) {
      pairs.push_back({i, id, overlap});
    }
  }
}

// Takes the pairs with the largest overlap, each detection and each object once.
void Match(std::vector<Pair> pairs, Arrangement& arrangement) {
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.overlap > b.overlap; });
  IdSet<ObjectId> taken;
  for (const Pair& pair : pairs) {
    if (!arrangement.objects[pair.detection].IsValid() && taken.Insert(pair.object)) {
      arrangement.objects[pair.detection] = pair.object;
      arrangement.overlap += pair.overlap;
      ++arrangement.matched;
    }
  }
}

}  // namespace

Arrangement CompareArrangement(const Map& map, const ObjectIndex& index, const Sensor& sensor,
                               const Frame& frame, const Rigid3& cam_from_world, IslandId island,
                               const ObjectOptions& options) {
  Arrangement arrangement;
  arrangement.objects.resize(frame.detections.size());
  std::vector<ObjectId> mapped;
  for (const ObjectId id : index.FindVisible(sensor, cam_from_world, island)) {
    if (map.objects().At(id).state == ObjectState::kMapped) {
      mapped.push_back(id);
    }
  }
  std::vector<Pair> pairs;
  for (const ObjectId id : mapped) {
    AddPairs(frame, sensor, cam_from_world, id, map.objects().At(id), pairs);
  }
  Match(std::move(pairs), arrangement);
  const ImageKnowledge image{frame, cam_from_world, {}, arrangement.objects};
  for (const ObjectId id : mapped) {
    const bool is_found = std::find(arrangement.objects.begin(), arrangement.objects.end(), id) !=
                          arrangement.objects.end();
    if (!is_found && FindVisibility(map, sensor, image, map.objects().At(id), options) ==
                         LocationVisibility::kVisible) {
      ++arrangement.missed;
    }
  }
  return arrangement;
}

}  // namespace hullslam
