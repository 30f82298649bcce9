// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/ply_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <map>
#include <numbers>
#include <string>
#include <vector>

namespace hullslam {
namespace {

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
