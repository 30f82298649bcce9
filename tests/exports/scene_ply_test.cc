// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "exports/single_files.h"
#include "files/bytes.h"
#include "results/ply_file.h"
#include "support/made_export.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

TEST(ScenePly, PointsAreReadBackWithTheirColours) {
  const TemporaryFolder folder;
  const ExportModel model = MadeExportModel();
  const PlyPoints read = ReadPlyPoints(folder.Write("points.ply", FormatPointsPly(model.points)));
  ASSERT_EQ(read.positions.size(), 2U);
  EXPECT_EQ(read.positions[0], Eigen::Vector3f(1.0f, -2.0f, 3.0f));
  EXPECT_EQ(read.colours[1], (Colour{0, 64, 255}));
}

TEST(ScenePly, HasPointsThenCamerasThenObjects) {
  const TemporaryFolder folder;
  const ExportModel model = MadeExportModel();
  const std::string text = FormatScenePly(model, ObjectShape::kBoxes);
  // Four triangles per camera and twelve per box.
  EXPECT_NE(text.find("element face 32\n"), std::string::npos);
  const PlyPoints read = ReadPlyPoints(folder.Write("scene.ply", text));
  ASSERT_EQ(read.positions.size(), 2U + 2U * 5U + 2U * 8U);
  EXPECT_EQ(read.positions[2], Eigen::Vector3f::Zero()) << "the first camera";
  EXPECT_EQ(read.positions[7], Eigen::Vector3f(1.0f, 0.0f, 0.0f)) << "the second camera";
  for (size_t corner = 3; corner < 7; ++corner) {
    EXPECT_GT(read.positions[corner].z(), 0.0f) << "the cameras look along z";
  }
  EXPECT_EQ(read.colours[12], ColourOfClass("cup"));
  EXPECT_TRUE(read.positions[12].isApprox(Eigen::Vector3f(0.3f - 0.5f, 0.1f - 0.25f, 1.875f)));
}

TEST(ScenePly, VerticesOfAMeshHaveTheIdOfTheirObject) {
  Mesh mesh;
  mesh.scene = {{{1.0F, 2.0F, 3.0F}}, {{7, 8, 9}}, {}};
  mesh.objects.push_back({ObjectId(4),
                          "cup",
                          {{{0.0F, 0.0F, 1.0F}, {1.0F, 0.0F, 1.0F}, {0.0F, 1.0F, 1.0F}},
                           {{1, 1, 1}, {2, 2, 2}, {3, 3, 3}},
                           {{0, 1, 2}}}});
  const std::string text = FormatMeshPly(mesh);
  EXPECT_NE(text.find("element vertex 4\n"), std::string::npos);
  EXPECT_NE(text.find("property int object\nelement face 1\n"), std::string::npos);
  const std::string bytes = text.substr(text.find("end_header\n") + 11);
  ByteReader reader(bytes, "mesh.ply");
  for (const int32_t object : {-1, 4, 4, 4}) {
    reader.GetRaw(15);
    EXPECT_EQ(reader.Get<int32_t>(), object);
  }
  EXPECT_EQ(reader.Get<uint8_t>(), 3);
  for (const int32_t corner : {1, 2, 3}) {
    EXPECT_EQ(reader.Get<int32_t>(), corner) << "counted over the whole file";
  }
  reader.ExpectEnd();
}

TEST(ScenePly, AnEmptyModelHasNoFaces) {
  const std::string text = FormatScenePly(ExportModel(), ObjectShape::kEllipsoids);
  EXPECT_NE(text.find("element vertex 0\n"), std::string::npos);
  EXPECT_TRUE(text.ends_with("end_header\n"));
}

// The point is sqrt(14) m from the first camera; the pyramids are a twentieth of this high, and the
// corners of their open side are those of the image.
TEST(ScenePly, CamerasAreATwentiethOfTheDistanceHigh) {
  const TemporaryFolder folder;
  ExportModel model = MadeExportModel();
  model.points.resize(1);
  const PlyPoints read =
      ReadPlyPoints(folder.Write("scene.ply", FormatScenePly(model, ObjectShape::kBoxes)));
  const double height = std::sqrt(14.0) / 20.0;
  const std::vector<Eigen::Vector2d> corners = {{0, 0}, {160, 0}, {160, 120}, {0, 120}};
  for (size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d corner = read.positions.at(2 + i).cast<double>();
    EXPECT_NEAR(corner.z(), height, 1e-6);
    EXPECT_LT((model.camera->Project(corner) - corners[i]).norm(), 1e-3) << i;
    EXPECT_EQ(read.colours[2 + i], (Colour{255, 128, 0}));
  }
}

}  // namespace
}  // namespace hullslam
