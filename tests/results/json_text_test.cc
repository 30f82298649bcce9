// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/json_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hullslam/util/check.h"
#include "support/expect_error.h"

namespace hullslam {
namespace {

TEST(JsonText, RoundsToTheUnit) {
  EXPECT_EQ(Rounded(1.23456, 1e-2), 1.23);
  EXPECT_FALSE(std::signbit(Rounded(-1e-5, 1e-2)));
  EXPECT_THROW(Rounded(std::numeric_limits<double>::quiet_NaN(), 1e-2), CheckError);
}

TEST(JsonText, ReplacesBytesThatAreNotUtf8) {
  EXPECT_EQ(DumpLine({{"class", "a\xff\"<b>"}}), "{\"class\":\"a\xEF\xBF\xBD\\\"<b>\"}");
}

TEST(JsonText, HasOneEntryPerLine) {
  EXPECT_EQ(WithEntries({{"version", 1}}, "list", {"1", "2"}),
            "{\"version\":1,\"list\":[\n 1,\n 2\n]}\n");
}

Rigid3 Parse(const char* text) {
  const std::filesystem::path file = "f.json";
  const nlohmann::json json = nlohmann::json::parse(text);
  return PoseOf(JsonNode(file, json));
}

TEST(JsonPose, NormalisesTheRotation) {
  const Rigid3 pose = Parse("[1, 2, 3, 0, 0, 2, 2]");
  EXPECT_EQ(pose.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(pose.rotation.z(), std::sqrt(0.5), 1e-15);
}

TEST(JsonPose, RefusesOtherValues) {
  ExpectInputError([] { Parse("[1e155, 0, 0, 0, 0, 0, 1]"); },
                   {"f.json", "a position from -1e+08 to 1e+08 m"});
  ExpectInputError([] { Parse("[0, 0, 0, 0, 0, 0, 1e200]"); }, {"a quaternion of length 1"});
  ExpectInputError([] { Parse("[0, 0, 0, 0, 0, 0, 0]"); }, {"a quaternion of length 1"});
  ExpectInputError([] { Parse("[0, 0, 0]"); }, {"qx, qy, qz, qw"});
}

}  // namespace

}  // namespace hullslam
