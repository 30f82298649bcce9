// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "hullslam/frame/detection.h"
#include "hullslam/map/map.h"

namespace hullslam {

// An object as one keyframe sees it.
struct ResolvedObservation {
  KeyframeId keyframe;
  Rigid3 cam_from_world;
  const Detection* detection = nullptr;  // owned by the keyframe's frame
  // The landmarks that its keypoints show, camera frame, in the unit of the map.
  // AddSurfaceLandmarks finds them; they are empty before.
  std::vector<Eigen::Vector3d> landmarks = {};
};

// The observations of an object by increasing keyframe id. If there are more than `max_views` (0:
// no limit), they are evenly chosen and include the first and the last. They are valid until the
// map changes.
std::vector<ResolvedObservation> ResolveObservations(const Map& map, const ObjectLandmark& object,
                                                     size_t max_views = 0);

// The last `count` observations by increasing keyframe id, or all if there are fewer. Valid until
// the map changes.
std::vector<ResolvedObservation> LatestObservations(const Map& map, const ObjectLandmark& object,
                                                    size_t count);

// Finds the landmarks of the observations whose detection has no depth points: only those whose own
// depth is known well. This takes much longer than to collect the observations.
void AddSurfaceLandmarks(const Map& map, std::span<ResolvedObservation> observations);

// Known points of the object's surface: the depth points of the observation or, without these, its
// landmarks. Camera frame.
std::vector<Eigen::Vector3d> SurfacePoints(const ResolvedObservation& observation);

// The median depth (z) of its landmarks, in the unit of the map; null if fewer than three.
std::optional<double> LandmarkDepth(const ResolvedObservation& observation);

// Depth points of the observations in the world frame, evenly chosen, about `max_points` at most.
std::vector<Eigen::Vector3d> CollectPoints(std::span<const ResolvedObservation> observations,
                                           size_t max_points);

// An object with fewer depth points is treated as an object without depth.
inline constexpr size_t kMinDepthPoints = 20;
bool HasDepth(std::span<const ResolvedObservation> observations);

// Mean distance of a world point from the cameras; needs at least one observation.
double MeanDistance(std::span<const ResolvedObservation> observations,
                    const Eigen::Vector3d& point);

// Largest distance of a world point from the cameras; 0 without observations.
double LargestDistance(std::span<const ResolvedObservation> observations,
                       const Eigen::Vector3d& point);

// Mean of an observation's depth points in the world frame; needs at least one point.
Eigen::Vector3d Centroid(const ResolvedObservation& observation);

// Largest angle between the rays from the cameras to a world point, degrees.
double Parallax(std::span<const ResolvedObservation> observations, const Eigen::Vector3d& point);

}  // namespace hullslam
