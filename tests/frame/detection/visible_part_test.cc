// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/visible_part.h"

#include <gtest/gtest.h>

#include <vector>

#include "frame/made_masks.h"
#include "geometry/polygon.h"
#include "hullslam/geometry/conic.h"
#include "support/fisheye_camera.h"

namespace hullslam {
namespace {

Eigen::AlignedBox2d BoxOf(const PinholeCamera& camera) {
  const PinholeCamera::Bounds bounds = camera.UndistortedBounds();
  return {Eigen::Vector2d(bounds.min_x, bounds.min_y), Eigen::Vector2d(bounds.max_x, bounds.max_y)};
}

// An ellipse around this raw pixel.
std::vector<Eigen::Vector2d> EllipseAt(const PinholeCamera& camera, const Eigen::Vector2d& raw) {
  const Ellipse ellipse{.center = camera.Undistort(raw),
                        .shape = Eigen::Vector2d(900.0, 1600.0).asDiagonal()};
  return ellipse.Polygon(128);
}

TEST(VisiblePart, OfAPinholeIsCutByTheBox) {
  const PinholeCamera camera = PlainCamera();
  const auto polygon = EllipseAt(camera, {320.0, 470.0});
  EXPECT_EQ(ConvexHull(VisiblePart(polygon, camera, BoxOf(camera))),
            ConvexHull(ClipToBox(polygon, BoxOf(camera))));
}

// The lower side of the image is far inside the box of the undistorted image.
TEST(VisiblePart, OfAFisheyeIsCutByTheBorderOfTheRawImage) {
  const PinholeCamera camera = FisheyeCamera();
  const auto polygon = EllipseAt(camera, {320.0, 480.0});
  const auto visible = VisiblePart(polygon, camera, BoxOf(camera));
  ASSERT_GE(visible.size(), 3u);
  EXPECT_NEAR(SignedArea(visible), 0.5 * SignedArea(polygon), 0.05 * SignedArea(polygon));
  for (const Eigen::Vector2d& point : visible) {
    EXPECT_LE(camera.Distort(point).y(), 480.0 + 1e-6);
  }
  const auto inside = EllipseAt(camera, {320.0, 240.0});
  EXPECT_NEAR(SignedArea(VisiblePart(inside, camera, BoxOf(camera))), SignedArea(inside), 1e-6);
  EXPECT_TRUE(VisiblePart(EllipseAt(camera, {320.0, 560.0}), camera, BoxOf(camera)).empty());
}

}  // namespace
}  // namespace hullslam
