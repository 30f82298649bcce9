// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "support/drawn_depth.h"

namespace hullslam {
namespace {

constexpr double kStep = 0.01;
constexpr double kRadius = 0.25;
const Eigen::Vector3d kCentre(0.12, -0.03, 0.07);

VoxelVolume VolumeOf(const std::vector<Eigen::Vector3d>& positions, const HitDistance& hit,
                     TaskRunner& runner) {
  SystemOptions options = SmallCameraOptions();
  options.camera.fx = options.camera.fy = 250.0;
  VoxelVolume volume(kStep, 4.0 * kStep);
  for (const Eigen::Vector3d& position : positions) {
    EXPECT_TRUE(volume.Add(DrawView(options, {LookAt(position, kCentre)}, hit), 100'000, runner));
  }
  return volume;
}

// A sphere that is seen from 14 sides: all of it.
SurfaceMesh Sphere(TaskRunner& runner) {
  std::vector<Eigen::Vector3d> positions;
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3d side(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    if (std::abs(side.squaredNorm() - 2.0) > 0.5 && side.norm() > 0.5) {
      positions.push_back(kCentre + 1.1 * side.normalized());
    }
  }
  return ExtractSurface(VolumeOf(positions, SphereAt(kCentre, kRadius), runner), runner);
}

Eigen::Vector3f NormalOf(const SurfaceMesh& surface, const TriangleMesh::Triangle& triangle) {
  const Eigen::Vector3f a = surface.positions[triangle[0]];
  return (surface.positions[triangle[1]] - a).cross(surface.positions[triangle[2]] - a);
}

TEST(Surface, OfASphereIsAFractionOfAVoxelAway) {
  SerialRunner runner;
  const SurfaceMesh surface = Sphere(runner);
  ASSERT_GT(surface.positions.size(), 5000U);
  double sum = 0.0;
  double most = 0.0;
  for (const Eigen::Vector3f& position : surface.positions) {
    const double error = std::abs((position.cast<double>() - kCentre).norm() - kRadius);
    sum += error;
    most = std::max(most, error);
  }
  EXPECT_LT(sum / static_cast<double>(surface.positions.size()), 0.1 * kStep);
  EXPECT_LT(most, 0.5 * kStep);
}

// Each edge of a closed surface belongs to two triangles, in opposite directions.
TEST(Surface, OfASphereIsClosedAndFacesOutwards) {
  SerialRunner runner;
  const SurfaceMesh surface = Sphere(runner);
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (const TriangleMesh::Triangle& triangle : surface.triangles) {
    for (size_t i = 0; i < 3; ++i) {
      ++edges[{triangle[i], triangle[(i + 1) % 3]}];
    }
    const Eigen::Vector3f outwards = surface.positions[triangle[0]] - kCentre.cast<float>();
    EXPECT_GT(NormalOf(surface, triangle).dot(outwards), 0.0F);
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, (edges[{edge.second, edge.first}]));
  }
  // Euler's formula for a sphere.
  EXPECT_EQ(surface.positions.size() + surface.triangles.size(), 2 + edges.size() / 2);
}

TEST(Surface, HasTheColourOfTheImages) {
  SerialRunner runner;
  const SurfaceMesh surface = Sphere(runner);
  ASSERT_EQ(surface.colours.size(), surface.positions.size());
  for (const Colour& colour : surface.colours) {
    EXPECT_EQ(colour, (Colour{10, 20, 30}));
  }
}

// A plane that two cameras see obliquely from opposite sides of its normal.
TEST(Surface, OfAPlaneIsExact) {
  SerialRunner runner;
  const Eigen::Vector3d normal = Eigen::Vector3d(0.2, 0.3, 1.0).normalized();
  const double offset = normal.dot(kCentre);
  const SurfaceMesh surface = ExtractSurface(VolumeOf({kCentre + Eigen::Vector3d(0.6, 0.0, 0.9),
                                                       kCentre + Eigen::Vector3d(-0.5, 0.2, 1.0)},
                                                      PlaneAt(normal, offset), runner),
                                             runner);
  ASSERT_GT(surface.positions.size(), 1000U);
  for (const Eigen::Vector3f& position : surface.positions) {
    EXPECT_NEAR(normal.dot(position.cast<double>()), offset, 0.02 * kStep);
  }
  for (const TriangleMesh::Triangle& triangle : surface.triangles) {
    EXPECT_GT(NormalOf(surface, triangle).dot(normal.cast<float>()), 0.0F);
  }
}

// A sphere in front of a plane: no triangle joins the border of the sphere with the plane.
TEST(Surface, DoesNotJoinWhatIsInFrontAndBehind) {
  SerialRunner runner;
  const HitDistance sphere = SphereAt(kCentre, kRadius);
  const HitDistance plane = PlaneAt(Eigen::Vector3d::UnitZ(), -1.0);
  const SurfaceMesh surface =
      ExtractSurface(VolumeOf(
                         {kCentre + Eigen::Vector3d(0.0, 0.1, 1.0)},
                         [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
                           return std::min(sphere(origin, direction), plane(origin, direction));
                         },
                         runner),
                     runner);
  ASSERT_GT(surface.positions.size(), 1000U);
  for (const Eigen::Vector3f& position : surface.positions) {
    const double of_sphere = std::abs((position.cast<double>() - kCentre).norm() - kRadius);
    const double of_plane = std::abs(static_cast<double>(position.z()) + 1.0);
    EXPECT_LT(std::min(of_sphere, of_plane), 0.5 * kStep);
  }
}

TEST(Surface, ThreadsGiveTheSameBits) {
  SerialRunner serial;
  ParallelRunner parallel(3);
  const SurfaceMesh one = Sphere(serial);
  const SurfaceMesh other = Sphere(parallel);
  EXPECT_EQ(one.positions, other.positions);
  EXPECT_EQ(one.colours, other.colours);
  EXPECT_EQ(one.triangles, other.triangles);
}

TEST(Surface, SmallPartsAreRemoved) {
  SurfaceMesh surface;
  for (int i = 0; i < 9; ++i) {
    surface.positions.emplace_back(static_cast<float>(i), 0.0F, 0.0F);
    surface.colours.push_back({static_cast<uint8_t>(i), 0, 0});
  }
  surface.triangles = {{0, 1, 2}, {4, 5, 6}, {7, 6, 5}};  // 3 and 8 have no triangle
  const SurfaceMesh kept = WithoutSmallParts(surface, 2);
  EXPECT_EQ(kept.triangles, (std::vector<TriangleMesh::Triangle>{{0, 1, 2}, {3, 2, 1}}));
  ASSERT_EQ(kept.positions.size(), 4U);
  EXPECT_EQ(kept.positions[0].x(), 4.0F);
  EXPECT_EQ(kept.colours[3][0], 7);
  EXPECT_EQ(WithoutSmallParts(surface, 1).triangles.size(), 3U);
  EXPECT_TRUE(WithoutSmallParts(surface, 3).positions.empty());
}

}  // namespace
}  // namespace hullslam
