// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/pose_objects.h"

#include <cmath>
#include <utility>

#include "costs/object_measurement.h"
#include "objects/association.h"
#include "objects/misfit.h"

namespace hullslam {
namespace {

bool TakesLines(ObjectResidual residual) {
  return residual == ObjectResidual::kTangent || residual == ObjectResidual::kAlgebraicPlane;
}

// The lines whose misfit is known, moved by it; empty where these are less than half.
std::vector<SilhouetteLine> KnownLines(const Sensor& sensor, const Rigid3& cam_from_world,
                                       const ObjectLandmark& object,
                                       std::span<const SilhouetteLine> lines) {
  std::vector<uint8_t> known;
  const std::vector<SilhouetteLine> moved =
      CompensateLines(sensor.camera, cam_from_world, object, lines, KeyframeId(), known);
  std::vector<SilhouetteLine> kept;
  for (size_t i = 0; i < moved.size(); ++i) {
    // Where the object is cut or hidden its true reach is not seen, so there is nothing to correct.
    if (known[i] != 0 && !moved[i].is_one_sided) {
      kept.push_back(moved[i]);
    }
  }
  return 2 * kept.size() >= lines.size() ? kept : std::vector<SilhouetteLine>();
}

}  // namespace

std::vector<ObjectId> FindMappedObjects(const Frame& frame, const Map& map,
                                        const TrackingContext& context,
                                        const PoseEstimate& estimate) {
  const ObjectOptions& objects = context.objects;
  const bool is_wanted = objects.enabled && (objects.joint_pose || objects.guided_matching);
  if (!is_wanted || frame.detections.empty() || map.objects().empty()) {
    return std::vector<ObjectId>(frame.detections.size());
  }
  AssociationOptions association;
  association.mapped_only = true;
  return AssociateDetections(map, context.sensor, frame, estimate.cam_from_world,
                             estimate.landmarks, association);
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
    PoseObject pose_object{object.ellipsoid, ToMeasurement(detection),
                           std::hypot(options.sigma, object.misfit_px)};
    if (options.misfit_compensation && TakesLines(options.residual)) {
      std::vector<SilhouetteLine> lines =
          KnownLines(sensor, cam_from_world, object, detection.lines);
      if (!lines.empty()) {
        pose_object.measurement.lines = found.lines.emplace_back(std::move(lines));
        pose_object.sigma_px = std::hypot(options.sigma, object.compensated_px);
      }
    }
    found.ids.push_back(ids[i]);
    found.objects.push_back(pose_object);
  }
  return found;
}

}  // namespace hullslam
