// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/ply_writer.h"

#include <gtest/gtest.h>

#include <cstring>

#include "results/ply_points.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

TEST(PlyWriter, ReadsBackWhatItWrote) {
  const TemporaryFolder folder;
  PlyWriter file;
  file.AddPoint({1.0, -2.0, 3.0}, {10, 20, 30});
  const Rigid3 pose(ExpSo3({0.0, 0.0, 1.5707963267948966}), {5.0, 0.0, 0.0});
  const TriangleMesh triangle{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}, {{0, 1, 2}}};
  file.AddMesh(triangle, pose, {2.0, 3.0, 4.0}, {1, 2, 3});
  const PlyPoints read = ReadPlyPoints(folder.Write("a.ply", file.MeshFile()));
  ASSERT_EQ(read.positions.size(), 4U);
  EXPECT_EQ(read.positions[0], Eigen::Vector3f(1.0f, -2.0f, 3.0f));
  EXPECT_EQ(read.colours[0], (Colour{10, 20, 30}));
  // Stretched to (2, 0, 0), turned to (0, 2, 0), and moved.
  EXPECT_TRUE(read.positions[1].isApprox(Eigen::Vector3f(5.0f, 2.0f, 0.0f), 1e-6f));
  EXPECT_EQ(read.colours[3], (Colour{1, 2, 3}));
}

TEST(PlyWriter, FacesPointToTheVerticesOfTheirMesh) {
  PlyWriter file;
  file.AddPoint({0.0, 0.0, 0.0}, {});
  const TriangleMesh triangle{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}, {{0, 1, 2}}};
  file.AddMesh(triangle, {}, {1.0, 1.0, 1.0}, {});
  file.AddMesh(triangle, {}, {1.0, 1.0, 1.0}, {});
  const std::string text = file.MeshFile();
  EXPECT_NE(text.find("element face 2\n"), std::string::npos);
  int32_t corners[3];
  std::memcpy(corners, text.data() + text.size() - sizeof(corners), sizeof(corners));
  EXPECT_EQ(corners[0], 4);
  EXPECT_EQ(corners[2], 6);
}

TEST(PlyWriter, OnlyAFileOfMeshesHasAListOfFaces) {
  const PlyWriter file;
  EXPECT_NE(file.MeshFile().find("element face 0\n"), std::string::npos);
  EXPECT_EQ(file.PointFile().find("face"), std::string::npos);
}

}  // namespace
}  // namespace hullslam
