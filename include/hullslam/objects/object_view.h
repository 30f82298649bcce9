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

// Mean of a view's depth points in the world; needs one at least.
Eigen::Vector3d Centroid(const ObjectView& view);

// Largest angle between the rays from the cameras to a point of the world, degrees.
double Parallax(std::span<const ObjectView> views, const Eigen::Vector3d& point);

}  // namespace hullslam
