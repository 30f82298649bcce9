// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/detection.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/geometry/line2.h"
#include "hullslam/map/object_landmark.h"
#include "hullslam/objects/object_options.h"
#include "objects/resolved_observation.h"

namespace hullslam {

// Raw px per undistorted px, across a line with this normal, at an undistorted pixel. A line n.x +
// c = 0 has the gradient J^-T n in the raw image, with the derivative J of the distortion.
double RawShare(const PinholeCamera& camera, const Eigen::Vector2d& undistorted,
                const Eigen::Vector2d& normal);

// The lines with normals and offsets such that TangentDistance() is a distance in the raw image of
// a fisheye lens, to first order, where the line touches the hull; without such a lens as they are.
std::vector<SilhouetteLine> ScaleToRaw(const PinholeCamera& camera, const Detection& detection,
                                       std::span<const SilhouetteLine> lines);

// A line of a detection is the image of a plane through the camera's centre that touches the convex
// hull of the real object. The excess is the support function of that hull (largest n . x over its
// points, in the object's frame) minus the support function of the quadric. It depends only on the
// plane's normal n in the object's frame. So an excess that was measured in one observation is
// valid in every other observation that touches the object at the same n. The excess is the
// systematic part of the misfit, and it can be predicted.

// The plane of a line: unit normal in the object's frame, distances and pixels at one pose.
struct TangentPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  // outwards
  double excess = 0.0;            // support function of the hull minus that of the quadric, m
  double pixels_per_metre = 0.0;  // shift of the line in the image per shift of the plane
  double raw_per_metre = 0.0;     // the same in the raw image, to first order
};

// Nothing if the quadric is not in front of the camera.
std::optional<TangentPlane> PlaneOfLine(const PinholeCamera& camera, const Rigid3& cam_from_world,
                                        const Ellipsoid& ellipsoid, const Line2& line);

// The excess of all two-sided lines of the observations.
std::vector<MisfitSample> MeasureMisfit(const PinholeCamera& camera, const Ellipsoid& ellipsoid,
                                        std::span<const ResolvedObservation> observations);

// The excess at a normal, predicted from the samples of keyframes other than `left_out`: a locally
// linear fit with Gaussian weights. Nothing if too few samples are near.
std::optional<double> PredictExcess(std::span<const MisfitSample> samples,
                                    const Eigen::Vector3d& normal, KeyframeId left_out,
                                    const MisfitOptions& options = {});

// The lines of a detection, moved by the predicted excess. The moved lines are those that the
// quadric itself would give. Lines whose excess cannot be predicted are not moved. `known` gets one
// entry per line: 1 if it was moved, else 0.
std::vector<SilhouetteLine> CompensateLines(const PinholeCamera& camera,
                                            const Rigid3& cam_from_world,
                                            const ObjectLandmark& object,
                                            std::span<const SilhouetteLine> lines,
                                            KeyframeId left_out, std::vector<uint8_t>& known,
                                            const MisfitOptions& options = {});

// RMS of the tangent distances of the observations' two-sided lines, px: without compensation, and
// after compensation with the samples of the other observations.
struct MisfitSpread {
  double plain_px = 0.0;
  double compensated_px = 0.0;
};
MisfitSpread MeasureSpread(const PinholeCamera& camera, const ObjectLandmark& object,
                           std::span<const ResolvedObservation> observations,
                           const MisfitOptions& options = {});

// RMS of the tangent distances of the observations' two-sided lines over the RMS of the sizes of
// their masks (the square root of the area of the hull). 0 if there is no two-sided line.
double RelativeMisfit(const PinholeCamera& camera, const Ellipsoid& ellipsoid,
                      std::span<const ResolvedObservation> observations);

}  // namespace hullslam
