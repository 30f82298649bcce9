// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/ply_points.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "results/ply_file.h"
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

}  // namespace
}  // namespace hullslam
