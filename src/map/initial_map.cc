// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/initial_map.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "util/statistics.h"

namespace hullslam {
namespace {

constexpr double kMinAdjustedParallax = 1.0;  // degrees

// The angle between the rays from the first and the last view that this share of the points
// reaches, degrees.
double TypicalParallax(const InitialMap& map, double share) {
  const Eigen::Vector3d last = Inverse(map.views.back().cam_from_world).translation;
  std::vector<double> angles;
  for (const InitialMap::Point& point : map.points) {
    const Eigen::Vector3d ray = point.position - last;
    angles.push_back(std::atan2(point.position.cross(ray).norm(), point.position.dot(ray)));
  }
  return ReachedBy(share, std::move(angles)) * 180.0 / std::numbers::pi;
}

// Makes the median depth of the points in the first view 1.
void Normalise(InitialMap& map) {
  std::vector<double> depths;
  for (const InitialMap::Point& point : map.points) {
    depths.push_back(point.position.z());
  }
  const double scale = 1.0 / Median(std::move(depths));
  for (InitialMap::View& view : map.views) {
    view.cam_from_world.translation *= scale;
  }
  for (InitialMap::Point& point : map.points) {
    point.position *= scale;
  }
}

}  // namespace

std::optional<InitialisationFailure> FinishInitialMap(InitialMap& map, double share) {
  std::erase_if(map.points, [](const auto& point) { return !(point.position.z() > 0.0); });
  if (map.points.size() < kMinInitialPoints) {
    return InitialisationFailure::kTooFewPoints;
  }
  // Two views with wrong matches may seem to have parallax. The adjustment with the views between
  // them reveals that they have none.
  if (TypicalParallax(map, share) < kMinAdjustedParallax) {
    return InitialisationFailure::kTooLittleParallax;
  }
  Normalise(map);
  return std::nullopt;
}

}  // namespace hullslam
