// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/calibrate_pair.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "calibration/made_recording.h"
#include "hullslam/util/error.h"
#include "support/made_room.h"
#include "support/turned_right.h"

namespace hullslam {
namespace {

constexpr double kOneDegree = std::numbers::pi / 180.0;
constexpr double kRoomBaseline = 0.12;  // m

struct Turned {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  double row_offset = 0.0;
};

// Pairs of the room; a frame that is a multiple of five cannot be read.
CameraRecording RoomRecording(const MadeRoom& room, const Turned& turned) {
  return {14, [&room, turned](size_t frame, const PinholeCamera& camera) {
            if (frame % 5 == 0) {
              throw InputError("cannot be read");
            }
            const int number = static_cast<int>(frame);
            ImageInput pair;
            pair.grey = room.Render(number).grey;
            pair.right = TurnedRight(room.RenderRight(number, kRoomBaseline), camera, turned.turn,
                                     turned.row_offset);
            return pair;
          }};
}

TEST(MatchAnywhere, FindsPointsOfATurnedImage) {
  const MadeRoom room;
  const cv::Mat left = room.Render(0).grey;
  const cv::Mat right = room.RenderRight(0, kRoomBaseline);
  const size_t usual = MatchAnywhere(left, right, room.camera()).size();
  EXPECT_GT(usual, 100U);
  for (const Turned& turned :
       {Turned{.turn = {3.0 * kOneDegree, 0.0, 0.0}}, Turned{.turn = {0.0, 0.0, 3.0 * kOneDegree}},
        Turned{.row_offset = 20.0}}) {
    const cv::Mat image = TurnedRight(right, room.camera(), turned.turn, turned.row_offset);
    EXPECT_GT(MatchAnywhere(left, image, room.camera()).size(), usual / 2);
  }
}

TEST(MatchPairs, TheRotationOfImagesIsFound) {
  const MadeRoom room(2);
  PinholeCamera camera = room.camera();
  camera.bf = kRoomBaseline * camera.fx;
  for (const Turned& truth : {Turned{}, Turned{.turn = {0.5 * kOneDegree, 0.0, -0.3 * kOneDegree}},
                              Turned{.turn = {-3.0 * kOneDegree, 0.0, 0.0}}}) {
    const std::vector<CameraRecording> recordings = {RoomRecording(room, truth)};
    const std::vector<MatchedPair> pairs = MatchPairs(recordings, camera, nullptr);
    EXPECT_EQ(pairs.size(), 11U);
    const PairRows rows = FitPairRows(pairs, camera);
    const bool is_turned = truth.turn.norm() > 0.0;
    EXPECT_EQ(rows.is_changed, is_turned);
    EXPECT_FALSE(rows.is_late);
    EXPECT_NEAR(rows.Of(PairNumber::kPitch).value, truth.turn.x(),
                std::max(0.02 * kOneDegree, 3.0 * rows.Of(PairNumber::kPitch).sigma));
    EXPECT_NEAR(rows.Of(PairNumber::kRoll).value, truth.turn.z(),
                std::max(0.02 * kOneDegree, 3.0 * rows.Of(PairNumber::kRoll).sigma));
  }
}

TEST(MatchPairs, AnInterruptionEndsIt) {
  Cancellation cancellation;
  cancellation.Request();
  const MadeRoom room(2);
  const std::vector<CameraRecording> recordings = {RoomRecording(room, {})};
  EXPECT_TRUE(MatchPairs(recordings, room.camera(), &cancellation).empty());
}

MadeRecording PairRecording(const MadeMotion& motion, double offset, bool is_plane, uint32_t seed) {
  MadeRecordingOptions options = ShortRecording(motion, true, seed);
  options.truth.readout_time = 0.0;
  options.truth.camera.k1 = options.truth.camera.k2 = 0.0;
  options.truth.is_pair = true;
  options.truth.disparity_offset = offset;
  options.is_plane = is_plane;
  return MadeRecording(options);
}

CameraModel GivenPair() {
  CameraModel model = MadeCamera();
  model.camera.k1 = model.camera.k2 = 0.0;
  model.is_pair = true;
  return model;
}

PairEvidence YawIn(const MadeRecording& recording) {
  CameraCalibrationResult result =
      CalibrateCamera(recording.problem(), GivenPair(), {.choice = {.distortion = false}});
  const PairEvidence yaw = TakeYaw(result);
  EXPECT_EQ(result.evidence.Find("disparity_offset"), nullptr);
  EXPECT_FALSE(result.IsCalibrated("disparity_offset"));
  EXPECT_EQ(result.model.disparity_offset, 0.0);
  return yaw;
}

TEST(TakeYaw, IsFoundWithThingsAtAllDistances) {
  int within = 0;
  for (uint32_t seed = 0; seed < 10; ++seed) {
    const double offset = seed % 2 == 0 ? 0.0 : 1.5;
    const PairEvidence yaw = YawIn(PairRecording(kHandHeld, offset, false, seed));
    EXPECT_TRUE(yaw.is_determined) << seed;
    const double error = std::abs(yaw.value - YawOf(offset, GivenPair().camera));
    within += error <= 2.0 * yaw.sigma ? 1 : 0;
    EXPECT_LT(error, 4.0 * yaw.sigma) << seed;
  }
  EXPECT_GE(within, 9);
}

TEST(TakeYaw, IsNotDeterminedIfEverythingIsAtOneDistance) {
  EXPECT_FALSE(YawIn(PairRecording(kAlongPlane, 1.5, true, 1)).is_determined);
}

TEST(PairCalibration, BothCamerasGetWhatWasCalibrated) {
  PairCalibration pair;
  pair.given = {.fx = 500.0, .fy = 500.0, .cx = 320.0, .cy = 240.0, .bf = 50.0};
  pair.rectified = {.fx = 510.0, .fy = 510.0, .cx = 315.0, .cy = 242.0, .bf = 51.0};
  pair.recorded.result.model.camera = pair.rectified;
  pair.recorded.result.model.camera.fx *= 1.02;
  pair.recorded.result.model.camera.fy *= 1.02;
  pair.recorded.result.model.camera.cx += 5.1;
  pair.deviation = {.turn = {0.01, 0.0, 0.0}, .row_offset = 3.0};
  const StereoRectifier rectifier(RectifiedPair(pair.given), "test");
  ASSERT_TRUE(rectifier.IsIdentity());
  const StereoCalibration cameras = pair.Cameras(rectifier);
  EXPECT_NEAR(cameras.left.fx, 510.0, 1e-9);
  EXPECT_NEAR(cameras.left.cx, 325.0, 1e-9);
  EXPECT_NEAR(cameras.left.bf, 0.1 * 510.0, 1e-9);
  EXPECT_NEAR(cameras.right.cy, 243.0, 1e-9);
  EXPECT_NEAR(LogSo3(cameras.right_from_left.rotation).x(), 0.01, 1e-9);
  EXPECT_NEAR(Inverse(cameras.right_from_left).translation.x(), 0.1, 1e-9);
}

}  // namespace
}  // namespace hullslam
