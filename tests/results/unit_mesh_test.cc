// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/unit_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <numbers>
#include <utility>

namespace hullslam {
namespace {

// The volume inside of a closed surface by the divergence theorem. It is positive if all triangles
// are anticlockwise seen from outside.
double VolumeInside(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const TriangleMesh::Triangle& triangle : mesh.triangles) {
    volume +=
        mesh.corners[triangle[0]].dot(mesh.corners[triangle[1]].cross(mesh.corners[triangle[2]])) /
        6.0;
  }
  return volume;
}

// Each edge must belong to two triangles, in opposite directions.
void ExpectClosed(const TriangleMesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (const TriangleMesh::Triangle& triangle : mesh.triangles) {
    for (size_t i = 0; i < 3; ++i) {
      ++edges[{triangle[i], triangle[(i + 1) % 3]}];
    }
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1U);
  }
}

TEST(UnitMesh, TheSphereIsClosedAndHasRadiusOne) {
  const TriangleMesh sphere = UnitSphere();
  ExpectClosed(sphere);
  EXPECT_EQ(sphere.triangles.size(), 216U);
  for (const Eigen::Vector3d& corner : sphere.corners) {
    EXPECT_NEAR(corner.norm(), 1.0, 1e-12);
  }
  const double volume = 4.0 / 3.0 * std::numbers::pi;
  EXPECT_LT(VolumeInside(sphere), volume);
  EXPECT_GT(VolumeInside(sphere), 0.9 * volume);
}

TEST(UnitMesh, TheCubeIsClosedAndHasVolumeEight) {
  const TriangleMesh cube = UnitCube();
  ExpectClosed(cube);
  EXPECT_NEAR(VolumeInside(cube), 8.0, 1e-12);
}

TEST(UnitMesh, AClassKeepsItsColour) {
  EXPECT_EQ(ColourOfClass("cup"), ColourOfClass("cup"));
  EXPECT_NE(ColourOfClass("cup"), ColourOfClass("book"));
}

}  // namespace
}  // namespace hullslam
