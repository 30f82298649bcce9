// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/ray_caster.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "synthetic/hash_noise.h"
#include "synthetic/object_models.h"
#include "synthetic/scene_builder.h"
#include "synthetic/tests/implicit_shape.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// A bare room with one object of each shape. The last object moves along x.
Scene TestScene() {
  SceneBuilder builder(1);
  const Palette palette = builder.AddBarePalette();
  builder.AddRoom({.half_x = 3.0, .half_y = 2.0, .height = 2.5}, palette);
  builder.AddObject(MakeSolid("vase", Shape::Superquadric({0.2, 0.3, 0.4}, 0.5, 0.7), {})
                        .Build({1.0, 1.0, 0.0}, 0.3));
  builder.AddObject(
      MakeSolid("apple", Shape::Ellipsoid({0.3, 0.2, 0.4}), {}).Build({1.0, -1.0, 0.5}, 0.5));
  builder.AddObject(MakeMug({}).Build({-1.0, 0.0, 0.7}, 0.5));
  SceneObject walker =
      MakeSolid("person", Shape::Box({0.2, 0.2, 0.8}), {}).Build(Vector3d::Zero(), 0.0);
  walker.motion = [](double time) { return Shift(-2.0 + time, -1.2, 0.8); };
  builder.AddObject(walker);
  return builder.Finish();
}

std::vector<Rigid3> Poses(const Scene& scene, double time) {
  std::vector<Rigid3> poses;
  for (const SceneObject& object : scene.objects) {
    poses.push_back(object.WorldFromObject(time));
  }
  return poses;
}

TEST(RayCaster, EveryRayInARoomHitsAPointOnASurface) {
  const Scene scene = TestScene();
  const RayCaster caster(scene);
  const std::vector<Rigid3> poses = Poses(scene, 0.5);
  RandomStream random(3);
  std::vector<int> hits(scene.objects.size(), 0);
  const Vector3d eye(0.1, 0.2, 1.2);
  for (int repeat = 0; repeat < 4000; ++repeat) {
    RayPacket packet;
    for (Vector3f& direction : packet.direction) {
      do {
        direction = Vector3d(random.Uniform(-1.0, 1.0), random.Uniform(-1.0, 1.0),
                             random.Uniform(-1.0, 1.0))
                        .cast<float>();
      } while (direction.norm() < 0.1F);
    }
    caster.Cast(eye.cast<float>(), poses, packet);
    for (size_t i = 0; i < RayPacket::kSize; ++i) {
      ASSERT_GE(packet.part[i], 0);
      const PlacedPart& placed = caster.parts()[static_cast<size_t>(packet.part[i])];
      const Vector3d point = eye + packet.distance[i] * packet.direction[i].cast<double>();
      const Rigid3 owner = placed.object < 0 ? Rigid3() : poses[static_cast<size_t>(placed.object)];
      const Vector3d local = Inverse(owner * placed.part->owner_from_part) * point;
      const Shape& shape = placed.part->shape;
      // The triangles are up to 4e-5 m inside the surface. Implicit values are relative to the
      // size.
      EXPECT_NEAR(Implicit(shape, local) *
                      (shape.kind == ShapeKind::kTorus ? shape.tube : shape.half.minCoeff()),
                  0.0, 1.5e-4);
      if (placed.object >= 0) {
        ++hits[static_cast<size_t>(placed.object)];
      }
    }
  }
  for (const int count : hits) {
    EXPECT_GT(count, 10);
  }
}

TEST(RayCaster, MatchesHandComputedDistances) {
  const Scene scene = TestScene();
  const RayCaster caster(scene);
  RayPacket packet;
  packet.direction.fill(Vector3f(0.0F, 0.0F, -1.0F));
  packet.direction[1] = Vector3f(0.0F, 0.5F, 0.0F);
  packet.direction[2] = Vector3f(0.0F, -1.0F, 0.0F);
  const auto cast = [&](double time) {
    caster.Cast({0.0F, 0.0F, 1.2F}, Poses(scene, time), packet);
  };
  cast(0.0);
  EXPECT_NEAR(packet.distance[0], 1.2F, 1e-5F);
  EXPECT_NEAR(packet.distance[1], 4.0F, 1e-5F);  // in units of the length of the direction
  EXPECT_NEAR(packet.distance[2], 2.0F, 1e-5F);  // the wall: the walker is at x = -2
  cast(2.0);
  EXPECT_NEAR(packet.distance[2], 1.0F, 1e-5F);  // the side of the walker at y = -1
  EXPECT_EQ(caster.parts()[static_cast<size_t>(packet.part[2])].object, 3);
}

// Rays along edges between the table and what stands on it hit two parts at the same distance.
TEST(RayCaster, HitsAreTheSameOnAllKindsOfProcessors) {
  const Scene scene = TestScene();
  const std::vector<Rigid3> poses = Poses(scene, 0.5);
  const RayCaster plain(scene, "threads=1,isa=sse2");
  const std::array<RayCaster, 3> others = {RayCaster(scene, "threads=1,isa=sse4.2"),
                                           RayCaster(scene, "threads=1,isa=avx2"),
                                           RayCaster(scene, "threads=1")};
  const Vector3f eye(0.1F, 0.2F, 1.2F);
  const int side = 400;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; j += RayPacket::kSize) {
      RayPacket packet;
      for (int k = 0; k < RayPacket::kSize; ++k) {
        const Vector3d angles(M_PI * (2.0 * i / side - 1.0), M_PI * ((j + k + 0.5) / side - 0.5),
                              0);
        packet.direction[static_cast<size_t>(k)] =
            Vector3d(std::cos(angles.x()) * std::cos(angles.y()),
                     std::sin(angles.x()) * std::cos(angles.y()), std::sin(angles.y()))
                .cast<float>();
      }
      plain.Cast(eye, poses, packet);
      for (const RayCaster& other : others) {
        RayPacket again = packet;
        other.Cast(eye, poses, again);
        ASSERT_EQ(again.distance, packet.distance) << i << " " << j;
        ASSERT_EQ(again.part, packet.part) << i << " " << j;
      }
    }
  }
}

}  // namespace
}  // namespace hullslam::synthetic
