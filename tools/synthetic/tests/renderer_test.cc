// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/renderer.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "camera/wide_lens.h"
#include "synthetic/camera_path.h"
#include "synthetic/mask_outline.h"
#include "synthetic/object_models.h"
#include "synthetic/scene_builder.h"
#include "synthetic/sequence_writer.h"
#include "synthetic/tests/implicit_shape.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

const Vector3d kEye(-1.0, -1.4, 1.3);

// Ellipsoids that float in a bare room, with a camera that does not move.
Scene EllipsoidScene() {
  SceneBuilder builder(1);
  const Palette palette = builder.AddBarePalette();
  builder.AddRoom({.half_x = 3.0, .half_y = 2.5, .height = 2.5}, palette);
  const auto add = [&](const Vector3d& half, const Vector3d& base, double yaw) {
    builder.AddObject(
        MakeSolid("apple", Shape::Ellipsoid(half), builder.Repeat(palette.speckle, 0.3))
            .Build(base, yaw));
  };
  add({0.20, 0.12, 0.08}, {0.0, 0.0, 0.9}, 0.6);
  add({0.05, 0.30, 0.20}, {-0.5, 1.0, 0.9}, 0.2);
  add({0.15, 0.15, 0.15}, {0.9, -0.2, 0.3}, 0.0);
  builder.scene().world_from_cam = [](double time) {
    return LookAt(kEye + Vector3d(0.1 * time, 0.0, 0.0), {0.0, 0.0, 0.95});
  };
  return builder.Finish();
}

// C* = P Q* P^T of an ellipsoid with the true pose and half extents.
Matrix3d DualConic(const SceneObject& object, const Rigid3& cam_from_world,
                   const PinholeCamera& camera) {
  Matrix4d pose = Matrix4d::Identity();
  pose.topRows<3>() = object.world_from_object.ToMatrix();
  Vector4d shape;
  shape << object.half_extents.cwiseAbs2(), -1.0;
  const Matrix4d quadric = pose * shape.asDiagonal() * pose.transpose();
  const Eigen::Matrix<double, 3, 4> projection = camera.Matrix() * cam_from_world.ToMatrix();
  return projection * quadric * projection.transpose();
}

// Signed distance from a pixel to the ellipse, to first order (Sampson).
double DistanceToConic(const Matrix3d& dual_conic, const Vector2d& pixel) {
  const Matrix3d conic = dual_conic.inverse();
  const Vector3d x = pixel.homogeneous();
  return x.dot(conic * x) / (2.0 * (conic * x).head<2>().norm());
}

TEST(Renderer, MasksAreTheProjectionsOfTheTrueDualQuadrics) {
  const Scene scene = EllipsoidScene();
  const PinholeCamera camera = SyntheticCamera();
  const RenderedFrame frame = Renderer(scene, camera).Render(0.0);
  const auto outlines = FindOutlines(frame.instance, 100);
  ASSERT_EQ(outlines.size(), scene.objects.size());
  for (const InstanceOutline& outline : outlines) {
    const Matrix3d dual = DualConic(scene.objects[static_cast<size_t>(outline.object)],
                                    Inverse(scene.world_from_cam(0.0)), camera);
    double sum = 0.0;
    for (const Vector2d& vertex : outline.vertices) {
      const double distance = DistanceToConic(dual, vertex);
      EXPECT_LT(std::abs(distance), 0.8) << vertex.transpose();
      sum += distance;
    }
    // The masks are biased neither to the inside nor to the outside.
    EXPECT_NEAR(sum / static_cast<double>(outline.vertices.size()), 0.0, 0.1);
  }
}

// An outline of raw pixels, undistorted, is that of the projected quadric: across, a raw pixel is
// 1 / sqrt(det J) undistorted ones.
TEST(Renderer, MasksOfAFisheyeAreTheProjectionsOfTheTrueDualQuadrics) {
  const Scene scene = EllipsoidScene();
  const PinholeCamera camera = SyntheticFisheye(150.0);
  const Rigid3 world_from_cam =
      scene.world_from_cam(0.0) * Rigid3(ExpSo3({0.0, 0.9, 0.0}), Vector3d::Zero());
  Scene turned = scene;  // the objects are in the outer part of the image
  turned.world_from_cam = [&](double) { return world_from_cam; };
  const RenderedFrame frame = Renderer(turned, camera).Render(0.0);
  const auto outlines = FindOutlines(frame.instance, 100);
  ASSERT_GE(outlines.size(), 2u);
  double farthest = 0.0;
  for (const InstanceOutline& outline : outlines) {
    const Matrix3d dual = DualConic(scene.objects[static_cast<size_t>(outline.object)],
                                    Inverse(world_from_cam), camera);
    for (const Vector2d& vertex : outline.vertices) {
      const Vector2d pixel = camera.Undistort(vertex);
      const double stretch = camera.DistortionJacobian(pixel).inverse().norm();
      EXPECT_LT(std::abs(DistanceToConic(dual, pixel)), 0.9 * stretch) << vertex.transpose();
      farthest = std::max(farthest, camera.Unproject(pixel, 1.0).norm());
    }
  }
  EXPECT_GT(farthest, 2.0) << "some outline is more than 60 degrees from the axis";
}

TEST(Renderer, DepthOfAFisheyeIsAlongTheRay) {
  const Scene scene = EllipsoidScene();
  const PinholeCamera camera = SyntheticFisheye(200.0);
  const RenderedFrame frame = Renderer(scene, camera).Render(1.0);
  const Rigid3 world_from_cam = scene.world_from_cam(1.0);
  const double largest = LargestAngle(camera, 3.1);
  int behind = 0;
  for (int y = 0; y < camera.height; y += 7) {
    for (int x = 0; x < camera.width; x += 7) {
      const Vector3d ray = RayOfRawPixel(camera, Vector2d(x, y), largest);
      EXPECT_NEAR(frame.axial.at<float>(y, x), ray.z(), 1e-5);
      behind += ray.z() < 0.0 ? 1 : 0;
      if (frame.instance.at<int16_t>(y, x) >= 0) {
        continue;
      }
      const Vector3d point = world_from_cam * Vector3d(frame.depth.at<float>(y, x) * ray);
      const double wall = std::min(
          {3.0 - std::abs(point.x()), 2.5 - std::abs(point.y()), point.z(), 2.5 - point.z()});
      EXPECT_LT(std::abs(wall), 0.021) << x << " " << y;
    }
  }
  EXPECT_GT(behind, 100);
}

TEST(Renderer, DepthIsTheDepthOfTheEllipsoidOrTheWall) {
  const Scene scene = EllipsoidScene();
  const PinholeCamera camera = SyntheticCamera();
  const RenderedFrame frame = Renderer(scene, camera).Render(1.0);
  const Rigid3 world_from_cam = scene.world_from_cam(1.0);
  int on_objects = 0;
  for (int y = 0; y < camera.height; y += 3) {
    for (int x = 0; x < camera.width; x += 3) {
      const Vector3d point =
          world_from_cam * camera.Unproject(Vector2d(x, y), frame.depth.at<float>(y, x));
      const int object = frame.instance.at<int16_t>(y, x);
      if (object < 0) {
        const double wall = std::min(
            {3.0 - std::abs(point.x()), 2.5 - std::abs(point.y()), point.z(), 2.5 - point.z()});
        EXPECT_LT(std::abs(wall), 0.021);  // skirting boards are 2 cm thick
        continue;
      }
      const SceneObject& hit = scene.objects[static_cast<size_t>(object)];
      const Vector3d local = Inverse(hit.world_from_object) * point;
      // The triangles are up to 4e-5 m inside the surface. At grazing angles this is a larger error
      // along the ray, but the point is still near the surface.
      EXPECT_NEAR(Implicit(hit.parts[0].shape, local), 0.0, 2e-3);
      ++on_objects;
    }
  }
  EXPECT_GT(on_objects, 1000);
}

TEST(Renderer, AKnownPointIsSeenWhereTheTruePosePredictsIt) {
  // The centre of each ellipsoid is projected into its own mask. The depth at this pixel is the
  // depth of the centre minus the extent along the ray.
  const Scene scene = EllipsoidScene();
  const PinholeCamera camera = SyntheticCamera();
  const Renderer renderer(scene, camera);
  for (const double time : {0.0, 2.0}) {
    const RenderedFrame frame = renderer.Render(time);
    const Rigid3 cam_from_world = Inverse(scene.world_from_cam(time));
    for (size_t i = 0; i < scene.objects.size(); ++i) {
      const SceneObject& object = scene.objects[i];
      const Vector3d centre = cam_from_world * object.world_from_object.translation;
      const Vector2d pixel = camera.Project(centre);
      const int x = static_cast<int>(std::lround(pixel.x()));
      const int y = static_cast<int>(std::lround(pixel.y()));
      ASSERT_EQ(frame.instance.at<int16_t>(y, x), static_cast<int>(i));
      // On the ray through the centre, the surface is 1 / |S^-1 R^T d| before the centre.
      const Vector3d ray =
          object.world_from_object.rotation.conjugate() *
          (object.world_from_object.translation - scene.world_from_cam(time).translation)
              .normalized();
      const double before = 1.0 / ray.cwiseQuotient(object.half_extents).norm();
      const double expected = centre.z() * (1.0 - before / centre.norm());
      EXPECT_NEAR(frame.depth.at<float>(y, x), expected, 0.002);
    }
  }
}

// Each row has its own camera pose. A row must be equal to the same row of an image that a global
// shutter takes at the time of this row.
TEST(Renderer, ARollingShutterExposesRowAfterRow) {
  constexpr double kTime = 1.0;
  const Scene scene = EllipsoidScene();
  const PinholeCamera camera = SyntheticCamera();
  const RenderedFrame global = Renderer(scene, camera).Render(kTime);
  for (const double readout : {0.5, -0.5}) {
    const RenderedFrame frame = Renderer(scene, camera, readout).Render(kTime);
    for (const int y : {0, 100, 240, 400, 478}) {
      const RenderedFrame row =
          Renderer(scene, camera).Render(kTime + ((y + 0.5) / camera.height - 0.5) * readout);
      EXPECT_EQ(cv::norm(frame.depth.row(y), row.depth.row(y), cv::NORM_INF), 0.0) << "row " << y;
    }
    EXPECT_GT(cv::norm(frame.depth.row(0), global.depth.row(0), cv::NORM_INF), 0.01);
    EXPECT_LT(cv::norm(frame.depth.row(240), global.depth.row(240), cv::NORM_INF), 0.01);
  }
}

TEST(Renderer, IsReproducible) {
  const Scene scene = EllipsoidScene();
  PinholeCamera camera = SyntheticCamera();
  camera.width = 163;  // not a multiple of a packet
  camera.height = 121;
  const Renderer renderer(scene, camera);
  const RenderedFrame a = renderer.Render(0.4);
  const RenderedFrame b = renderer.Render(0.4);
  EXPECT_EQ(cv::norm(a.colour, b.colour, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(a.depth, b.depth, cv::NORM_INF), 0.0);
  EXPECT_EQ(a.colour.size(), cv::Size(163, 121));
}

}  // namespace
}  // namespace hullslam::synthetic
