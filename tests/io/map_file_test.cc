// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/io/map_file.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hullslam/io/text_rows.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

using Points = std::vector<Eigen::Vector3d>;

TEST(MapFile, HoldsLandmarksThenKeyframesByteByByte) {
  const std::string ply = FormatPly(Points{{1.0, -2.0, 0.5}}, Points{{0.0, 0.0, 1.0}});
  const std::string end = "end_header\n";
  const size_t data = ply.find(end) + end.size();
  EXPECT_EQ(ply.find("ply\nformat binary_little_endian 1.0\nelement vertex 2\n"), 0U);
  const std::string expected(
      "\x00\x00\x80\x3f\x00\x00\x00\xc0\x00\x00\x00\x3f\x80\x80\x80"
      "\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x80\x3f\xff\x80\x00",
      30);
  EXPECT_EQ(ply.substr(data), expected);
}

TEST(MapFile, AnEmptyMapIsAFileWithoutPoints) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "map.ply";
  WritePly(path, {}, {});
  const std::string ply = ReadFile(path);
  EXPECT_NE(ply.find("element vertex 0\n"), std::string::npos);
  EXPECT_TRUE(ply.ends_with("end_header\n"));
}

}  // namespace
}  // namespace hullslam
