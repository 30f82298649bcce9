// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/visible_part.h"

#include "geometry/polygon.h"

namespace hullslam {

std::vector<Eigen::Vector2d> VisiblePart(const std::vector<Eigen::Vector2d>& polygon,
                                         const PinholeCamera& camera,
                                         const Eigen::AlignedBox2d& image) {
  std::vector<Eigen::Vector2d> inside = ClipToBox(polygon, image);
  std::vector<Eigen::Vector2d> raw;
  for (const Eigen::Vector2d& point : inside) {
    raw.push_back(camera.Distort(point));
  }
  const Eigen::AlignedBox2d raw_image(Eigen::Vector2d::Zero(),
                                      Eigen::Vector2d(camera.width, camera.height));
  if (raw_image.contains(BoundingBox(raw))) {
    return inside;
  }
  std::vector<Eigen::Vector2d> visible;
  for (const Eigen::Vector2d& point : ClipToBox(raw, raw_image)) {
    visible.push_back(camera.Undistort(point));
  }
  return ConvexHull(visible);
}

}  // namespace hullslam
