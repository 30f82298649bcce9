// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "hullslam/frame/detection.h"
#include "hullslam/map/map.h"

namespace hullslam {

// An object as one keyframe sees it.
struct ObjectView {
  KeyframeId keyframe;
  Rigid3 cam_from_world;
  const Detection* detection = nullptr;  // owned by the keyframe's frame
};

// The views of an object by increasing keyframe id; at most `max_views`, evenly chosen with the
// first and the last among them (0: all). Good until the map is written.
std::vector<ObjectView> CollectViews(const Map& map, const ObjectLandmark& object,
                                     size_t max_views = 0);

// Depth points of the views in the world, at most about `max_points`, evenly taken.
std::vector<Eigen::Vector3d> CollectPoints(std::span<const ObjectView> views, size_t max_points);

// Fewer depth points tell nothing of a shape: the object is treated as one without depth.
inline constexpr size_t kMinDepthPoints = 20;
bool HasDepth(std::span<const ObjectView> views);

// Mean distance of a point of the world from the cameras; needs one view at least.
double MeanDistance(std::span<const ObjectView> views, const Eigen::Vector3d& point);

// Mean of a view's depth points in the world; needs one at least.
Eigen::Vector3d Centroid(const ObjectView& view);

// Largest angle between the rays from the cameras to a point of the world, degrees.
double Parallax(std::span<const ObjectView> views, const Eigen::Vector3d& point);

}  // namespace hullslam
