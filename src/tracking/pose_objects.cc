// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/pose_objects.h"

#include <utility>

#include "objects/association.h"
#include "objects/misfit.h"
#include "objects/object_constraint.h"

namespace hullslam {
namespace {

// The lines whose misfit is known, moved by it; empty where these are less than half of the lines.
std::vector<SilhouetteLine> KnownLines(const Sensor& sensor, const Rigid3& cam_from_world,
                                       const ObjectLandmark& object,
                                       std::span<const SilhouetteLine> lines,
                                       const MisfitOptions& options) {
  std::vector<uint8_t> known;
  const std::vector<SilhouetteLine> moved =
      CompensateLines(sensor.camera, cam_from_world, object, lines, KeyframeId(), known, options);
  std::vector<SilhouetteLine> kept;
  for (size_t i = 0; i < moved.size(); ++i) {
    // Where the object is cut or hidden, its extent is not seen, so there is nothing to correct.
    if (known[i] != 0 && !moved[i].is_one_sided) {
      kept.push_back(moved[i]);
    }
  }
  return 2 * kept.size() >= lines.size() ? kept : std::vector<SilhouetteLine>();
}

}  // namespace

std::vector<ObjectId> FindMappedObjects(const Map& map, const Sensor& sensor, const Frame& frame,
                                        const Rigid3& cam_from_world,
                                        std::span<const LandmarkId> landmarks,
                                        const AssociationOptions& options) {
  return AssociateDetections(map, sensor, frame, cam_from_world, landmarks,
                             AssociationScope::kMapped, options);
}

PoseObjects MakePoseObjects(const Map& map, const Sensor& sensor, const Frame& frame,
                            const Rigid3& cam_from_world, std::span<const ObjectId> ids,
                            const ObjectOptions& options) {
  PoseObjects found;
  for (size_t i = 0; i < ids.size(); ++i) {
    if (!ids[i].IsValid()) {
      continue;
    }
    const ObjectLandmark& object = map.objects().At(ids[i]);
    const Detection& detection = frame.detections[i];
    PoseObject pose_object{object.ellipsoid, &detection, {}, object.compensated_px};
    if (options.misfit_compensation && TakesLines(options.pose.constraint.residual)) {
      pose_object.lines =
          KnownLines(sensor, cam_from_world, object, detection.lines, options.misfit);
    }
    if (pose_object.lines.empty()) {
      pose_object.lines = detection.lines;
      pose_object.misfit_px = object.misfit_px;
    }
    found.ids.push_back(ids[i]);
    found.objects.push_back(std::move(pose_object));
  }
  return found;
}

}  // namespace hullslam
