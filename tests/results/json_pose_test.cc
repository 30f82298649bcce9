// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/json_pose.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/expect_error.h"

namespace hullslam {
namespace {

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
