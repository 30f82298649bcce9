// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/euroc_states.h"

#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

class EurocStates : public testing::Test {
 protected:
  Trajectory Read(const std::string& text, const Rigid3& body_from_cam = Rigid3()) {
    return ReadEurocStates(folder_.Write("data.csv", text), body_from_cam);
  }

  const TemporaryFolder folder_;
};

TEST_F(EurocStates, AreThoseOfTheCamera) {
  // The body has turned by 90 degrees about z. The camera is 1 m along the x axis of the body.
  const Rigid3 body_from_cam(Eigen::Quaterniond::Identity(), {1.0, 0.0, 0.0});
  const Trajectory poses = Read(
      "#timestamp, p_RS_R_x [m], ...\n"
      "1500000000,1,2,3,0.7071067811865476,0,0,0.7071067811865476,9,9,9\n",
      body_from_cam);
  ASSERT_EQ(poses.size(), 1U);
  EXPECT_EQ(poses[0].timestamp, 1.5);
  EXPECT_LT((poses[0].world_from_cam.translation - Eigen::Vector3d(1.0, 3.0, 3.0)).norm(), 1e-12);
  EXPECT_NEAR(AngularDistance(poses[0].world_from_cam.rotation, Eigen::Quaterniond::Identity()),
              std::numbers::pi / 2.0, 1e-12);
}

TEST_F(EurocStates, BrokenLinesAreRefused) {
  const std::string good = "1,0,0,0,1,0,0,0\n";
  ExpectInputError([&] { Read(""); }, {"data.csv", "no poses"});
  ExpectInputError([&] { Read(good + "2,0,0,0,1,0,0\n"); }, {"data.csv:2", "q_z"});
  ExpectInputError([&] { Read(good + "2.5,0,0,0,1,0,0,0\n"); }, {"data.csv:2", "'2.5'"});
  ExpectInputError([&] { Read(good + "-2,0,0,0,1,0,0,0\n"); }, {"data.csv:2", "'-2'"});
  ExpectInputError([&] { Read(good + good); }, {"data.csv:2", "does not come after"});
  ExpectInputError([&] { Read(good + "2,x,0,0,1,0,0,0\n"); }, {"data.csv:2", "p_x", "'x'"});
  ExpectInputError([&] { Read(good + "2,0,0,0,0,0,0,0\n"); }, {"data.csv:2", "quaternion"});
}

}  // namespace
}  // namespace hullslam
