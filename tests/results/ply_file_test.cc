// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/ply_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "files/bytes.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

const std::vector<Eigen::Vector3d> kLandmarks = {{1.0, 2.0, 3.0}, {-4.0, 0.5, 6.0}};
const std::vector<Eigen::Vector3d> kCentres = {{0.0, 0.0, 0.25}};

TEST(PlyPoints, AreThoseThatWereWritten) {
  const TemporaryFolder folder;
  const PlyPoints points =
      ReadPlyPoints(folder.Write("map.ply", FormatMapPly(kLandmarks, kCentres)));
  ASSERT_EQ(points.positions.size(), 3u);
  EXPECT_EQ(points.positions[1], Eigen::Vector3f(-4.0f, 0.5f, 6.0f));
  EXPECT_EQ(points.positions[2], Eigen::Vector3f(0.0f, 0.0f, 0.25f));
  EXPECT_EQ(points.colours[0][0], points.colours[0][2]);  // landmarks are grey
  EXPECT_GT(points.colours[2][0], points.colours[2][2]);  // cameras are orange
  EXPECT_EQ(points.left_out, 0u);
}

TEST(PlyPoints, LandmarksComeWithoutTheCentresOfKeyframes) {
  const TemporaryFolder folder;
  const auto path = folder.Write("map.ply", FormatMapPly(kLandmarks, kCentres));
  EXPECT_EQ(ReadMapLandmarks(path).positions.size(), kLandmarks.size());
  EXPECT_EQ(ReadMapLandmarks(folder.Write("b.ply", FormatMapPly({}, kCentres))).colours.size(), 0u);
}

TEST(PlyPoints, ImplausiblePositionsAreCounted) {
  const TemporaryFolder folder;
  const std::vector<Eigen::Vector3d> landmarks = {
      {0.0, 0.0, 1.0}, {std::numeric_limits<double>::quiet_NaN(), 0.0, 1.0}, {1e7, 0.0, 0.0}};
  const PlyPoints points = ReadPlyPoints(folder.Write("map.ply", FormatMapPly(landmarks, {})));
  EXPECT_EQ(points.positions.size(), 1u);
  EXPECT_EQ(points.left_out, 2u);
}

TEST(PlyPoints, BrokenFilesAreRefused) {
  const TemporaryFolder folder;
  const std::string good = FormatMapPly(kLandmarks, kCentres);
  const auto expect_refusal = [&](const std::string& content, const char* reason) {
    const auto path = folder.Write("bad.ply", content);
    ExpectInputError([&] { ReadPlyPoints(path); }, {"bad.ply", reason});
  };
  expect_refusal("", "expected a binary");
  expect_refusal("solid\n", "expected a binary");
  expect_refusal(good.substr(0, 60), "expected a binary");
  expect_refusal(good.substr(0, good.size() - 1), "cut off");
  std::string many = good;
  many.replace(many.find("vertex 3"), 8, "vertex 999999999999");
  expect_refusal(many, "cut off");
  many.replace(many.find("vertex 999999999999"), 19, "vertex 99999999999999999999999");
  expect_refusal(many, "expected a binary");
}

// Two triangles of the scene and one of an object, as FormatMeshPly() writes them.
std::string MadeSurface(uint32_t last_corner = 4, float last_x = 1.0f) {
  ByteWriter body;
  for (int i = 0; i < 7; ++i) {
    body.PutMatrix(Eigen::Vector3f(i == 6 ? last_x : 1.0f, static_cast<float>(i), 2.0f));
    body.PutRaw("abc");
    body.Put(i < 4 ? int32_t{-1} : int32_t{7});
  }
  for (const std::array<uint32_t, 3>& face :
       {std::array{0U, 1U, 2U}, {1U, 2U, 3U}, {last_corner, 5U, 6U}}) {
    body.Put(uint8_t{3});
    for (const uint32_t corner : face) {
      body.Put(corner);
    }
  }
  return "ply\nformat binary_little_endian 1.0\nelement vertex 7\nproperty float x\n"
         "property float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
         "property uchar blue\nproperty int object\nelement face 3\n"
         "property list uchar int vertex_indices\nend_header\n" +
         body.bytes();
}

TEST(PlySurface, IsTheSceneWithoutItsObjects) {
  const TemporaryFolder folder;
  const PlySurface surface = ReadPlySurface(folder.Write("mesh.ply", MadeSurface()));
  ASSERT_EQ(surface.positions.size(), 4u);
  EXPECT_EQ(surface.positions[3], Eigen::Vector3f(1.0f, 3.0f, 2.0f));
  EXPECT_EQ(surface.colours[0], (Colour{'a', 'b', 'c'}));
  using Triangles = std::vector<TriangleMesh::Triangle>;
  EXPECT_EQ(surface.triangles, (Triangles{{0, 1, 2}, {1, 2, 3}}));
}

TEST(PlySurface, BrokenFilesAreRefused) {
  const TemporaryFolder folder;
  const auto expect_refusal = [&](const std::string& content, const char* reason) {
    const auto path = folder.Write("mesh.ply", content);
    ExpectInputError([&] { ReadPlySurface(path); }, {"mesh.ply", reason});
  };
  const std::string good = MadeSurface();
  expect_refusal("", "hullslam mesh");
  expect_refusal(FormatMapPly(kLandmarks, kCentres), "hullslam mesh");
  expect_refusal(good.substr(0, good.size() - 1), "fewer faces");
  expect_refusal(good.substr(0, good.size() - 100), "fewer vertices");
  expect_refusal(good + "x", "after its end");
  expect_refusal(MadeSurface(7), "no vertex");
  expect_refusal(MadeSurface(4, std::numeric_limits<float>::quiet_NaN()), "not finite");
  std::string many = good;
  many.replace(many.find("face 3"), 6, "face 4294967295");
  expect_refusal(many, "fewer faces");
  std::string square = good;
  square[square.size() - 13] = 4;
  expect_refusal(square, "no triangle");
}

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

using Points = std::vector<Eigen::Vector3d>;

TEST(MapPly, HasLandmarksThenKeyframes) {
  const std::string ply = FormatMapPly(Points{{1.0, -2.0, 0.5}}, Points{{0.0, 0.0, 1.0}});
  const std::string end = "end_header\n";
  const size_t data = ply.find(end) + end.size();
  EXPECT_EQ(ply.find("ply\nformat binary_little_endian 1.0\nelement vertex 2\n"), 0U);
  const std::string expected(
      "\x00\x00\x80\x3f\x00\x00\x00\xc0\x00\x00\x00\x3f\x80\x80\x80"
      "\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x80\x3f\xff\x80\x00",
      30);
  EXPECT_EQ(ply.substr(data), expected);
}

TEST(MapPly, AnEmptyMapGivesAFileWithoutPoints) {
  const std::string ply = FormatMapPly({}, {});
  EXPECT_NE(ply.find("element vertex 0\n"), std::string::npos);
  EXPECT_TRUE(ply.ends_with("end_header\n"));
}

float FloatAt(const std::string& bytes, size_t offset) {
  float value = 0.0F;
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  return value;
}

// The mesh in a file of FormatObjectsPly().
struct Mesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::string> colours;
  std::vector<std::array<int32_t, 3>> faces;

  explicit Mesh(const std::string& ply) {
    size_t vertex_count = 0;
    size_t face_count = 0;
    std::sscanf(ply.data() + ply.find("element vertex"), "element vertex %zu", &vertex_count);
    std::sscanf(ply.data() + ply.find("element face"), "element face %zu", &face_count);
    size_t offset = ply.find("end_header\n") + 11;
    for (size_t i = 0; i < vertex_count; ++i, offset += 15) {
      vertices.emplace_back(FloatAt(ply, offset), FloatAt(ply, offset + 4),
                            FloatAt(ply, offset + 8));
      colours.push_back(ply.substr(offset + 12, 3));
    }
    for (size_t i = 0; i < face_count; ++i, offset += 13) {
      EXPECT_EQ(ply.at(offset), 3);
      faces.emplace_back();
      std::memcpy(faces.back().data(), ply.data() + offset + 1, 12);
    }
    EXPECT_EQ(offset, ply.size());
  }
};

ObjectResult MakeObject(const std::string& label) {
  ObjectResult object;
  object.state = ObjectState::kMapped;
  object.label = label;
  object.ellipsoid = {Rigid3(ExpSo3({0.4, -0.3, 0.2}), {1.0, 2.0, 3.0}), {0.1, 0.2, 0.4}};
  return object;
}

TEST(ObjectsPly, ContainsTheEllipsoidAsAClosedSurfaceFacingOutwards) {
  const ObjectResult object = MakeObject("cup");
  const Mesh mesh(FormatObjectsPly(std::vector<ObjectResult>{object, object}));
  ASSERT_EQ(mesh.faces.size() % 2, 0U);
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    EXPECT_NEAR(object.ellipsoid.RadialDistance(vertex), 0.0, 1e-6);
  }
  double six_volumes = 0.0;
  std::map<std::pair<int32_t, int32_t>, int> edges;
  for (const auto& [a, b, c] : mesh.faces) {
    const Eigen::Vector3d center = object.ellipsoid.world_from_object.translation;
    six_volumes += (mesh.vertices.at(static_cast<size_t>(a)) - center)
                       .cross(mesh.vertices.at(static_cast<size_t>(b)) - center)
                       .dot(mesh.vertices.at(static_cast<size_t>(c)) - center);
    ++edges[{a, b}];
    ++edges[{b, c}];
    ++edges[{c, a}];
  }
  for (const auto& [edge, count] :
       edges) {  // two triangles meet at each edge and run along it in opposite directions
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(edges.contains({edge.second, edge.first}));
  }
  const double volume = 4.0 / 3.0 * std::numbers::pi * 0.1 * 0.2 * 0.4;
  EXPECT_NEAR(six_volumes / 6.0 / (2.0 * volume), 0.93, 0.07);
}

TEST(ObjectsPly, TheColourDependsOnTheClassOnly) {
  const Mesh mesh(FormatObjectsPly(
      std::vector<ObjectResult>{MakeObject("cup"), MakeObject("keyboard"), MakeObject("cup")}));
  const size_t corners = mesh.vertices.size() / 3;
  EXPECT_EQ(mesh.colours.front(), mesh.colours.back());
  EXPECT_EQ(mesh.colours[0], mesh.colours[corners - 1]);
  EXPECT_NE(mesh.colours[0], mesh.colours[corners]);
}

TEST(ObjectsPly, CandidatesAreLeftOut) {
  ObjectResult candidate = MakeObject("cup");
  candidate.state = ObjectState::kCandidate;
  const Mesh mesh(FormatObjectsPly(std::vector<ObjectResult>{candidate}));
  EXPECT_TRUE(mesh.vertices.empty());
  EXPECT_TRUE(mesh.faces.empty());
}

}  // namespace

}  // namespace hullslam
