// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/calibrate_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "calibration/made_recording.h"

namespace hullslam {
namespace {

// A camera that is wrong in every number.
CameraModel Wrong(CameraModel model) {
  model.camera.fx *= 1.03;
  model.camera.fy *= 1.03;
  model.camera.cx += 5.0;
  model.camera.cy -= 4.0;
  model.camera.k1 = model.camera.k2 = 0.0;
  model.readout_time = 0.0;
  return model;
}

// The principal point and the tangential distortion replace one another.
TEST(CalibrateCamera, TakesTheAxisOfTheLensAsAWholeOrNotAtAll) {
  MadeRecordingOptions options = ShortRecording(kHandHeld, true, 0);
  options.points = 150;
  options.truth.camera.p1 = 0.003;
  const CameraCalibrationResult result =
      CalibrateCamera(MadeRecording(options).problem(), Wrong(options.truth), {});
  EXPECT_FALSE(result.evidence.IsCentringDetermined());
  for (const char* const name : {"cx", "cy", "p1", "p2"}) {
    EXPECT_FALSE(result.IsCalibrated(name)) << name;
  }
  EXPECT_EQ(result.model.camera.cx, Wrong(options.truth).camera.cx);
  EXPECT_TRUE(result.IsCalibrated("fx"));
}

// An estimate within two sigmas is expected in 95 %; the jackknife's sigma is itself uncertain.
TEST(CalibrateCamera, FindsTheTruthWithinTwoSigmasInNineOfTenNumbers) {
  int near = 0;
  int all = 0;
  for (uint32_t seed = 0; seed < 6; ++seed) {
    MadeRecordingOptions options = ShortRecording(kHandHeld, seed % 2 == 0, seed);
    options.truth.disparity_offset = options.has_depth ? 0.4 : 0.0;
    options.views = 60;
    options.points = 500;
    CameraModel given = Wrong(options.truth);
    given.disparity_offset = 0.0;
    const CalibrationProblem problem = MadeRecording(options).problem();
    CameraCalibrationResult result = CalibrateCamera(problem, given, {});
    EXPECT_TRUE(result.is_changed);
    // A wrong camera leaves some points at wrong depths, which the next passes begin without.
    for (int pass = 1; pass < 4; ++pass) {
      result = CalibrateCamera(problem, result.model, {});
    }
    EXPECT_LT(std::abs(result.model.camera.fx - 520.0), 0.003 * 520.0);
    EXPECT_NEAR(result.model.camera.cx, 318.0, 2.0);
    EXPECT_NEAR(result.model.camera.cy, 243.0, 2.0);
    EXPECT_NEAR(result.model.readout_time, 0.02, 1e-3);
    EXPECT_NEAR(result.model.disparity_offset, options.truth.disparity_offset, 0.05);
    for (const ParameterEvidence& one : result.evidence.parameters) {
      const double error =
          one.parameter.ValueIn(result.model) - one.parameter.ValueIn(options.truth);
      near += std::abs(error) <= 2.0 * one.sigma ? 1 : 0;
      ++all;
    }
  }
  EXPECT_GE(near, 9 * all / 10) << all;
}

TEST(CalibrateCamera, KeepsARightCamera) {
  for (uint32_t seed = 0; seed < 8; ++seed) {
    const MadeRecordingOptions options = ShortRecording(kHandHeld, seed % 2 == 0, seed);
    const CameraCalibrationResult result =
        CalibrateCamera(MadeRecording(options).problem(), options.truth, {});
    EXPECT_FALSE(result.is_changed) << seed << ' ' << result.evidence_ratio;
    EXPECT_EQ(result.model.camera, options.truth.camera);
  }
}

TEST(CalibrateCamera, KeepsTheFocalLengthOfADepthCameraWithinTheScaleOfDepth) {
  const MadeRecordingOptions options = ShortRecording(kHandHeld, true, 1);
  const CalibrationProblem problem = MadeRecording(options).problem();
  for (const double factor : {1.015, 1.04}) {
    CameraModel given = options.truth;
    given.camera.fx *= factor;
    given.camera.fy *= factor;
    const CameraCalibrationResult result =
        CalibrateCamera(problem, given, {.trusted_focal_length = given.camera.fx});
    EXPECT_EQ(result.IsCalibrated("fx"), factor > 1.02) << factor;
    EXPECT_NEAR(result.model.camera.fx, factor > 1.02 ? 520.0 : given.camera.fx, 2.0);
    // In a later pass, the trusted one is still that of the user.
    const CameraCalibrationResult later =
        CalibrateCamera(problem, result.model, {.trusted_focal_length = given.camera.fx});
    EXPECT_EQ(later.IsCalibrated("fx"), factor > 1.02) << factor;
  }
}

TEST(CalibrateCamera, KeepsWhatIsNotDetermined) {
  const MadeRecordingOptions options = ShortRecording(kShiftAndRoll, true, 1);
  CameraModel given = options.truth;
  given.readout_time = 0.04;
  given.camera.fx = given.camera.fy = 525.0;
  const CameraCalibrationResult result =
      CalibrateCamera(MadeRecording(options).problem(), given, {});
  EXPECT_FALSE(result.IsCalibrated("fx"));
  EXPECT_EQ(result.model.camera.fx, 525.0);
  EXPECT_TRUE(result.IsCalibrated("readout_time"));
  EXPECT_NEAR(result.model.readout_time, 0.02, 1e-3);
}

// A structured-light camera has two cameras, of which each has its own clock and place.
TEST(CalibrateCamera, FindsWhenAndFromWhereDepthIsMeasured) {
  MadeRecordingOptions options = ShortRecording(kHandHeld, true, 4);
  options.views = 60;
  options.points = 500;
  options.truth.depth_time = -0.016;
  options.truth.depth_pose << 0.004, 0.012, -0.006, -0.011, 0.008, 0.0;
  CameraModel given = options.truth;
  given.depth_time = 0.0;
  given.depth_pose.setZero();
  const CameraCalibrationResult result =
      CalibrateCamera(MadeRecording(options).problem(), given, {});
  for (const ParameterEvidence& one : result.evidence.parameters) {
    const double error = one.parameter.ValueIn(result.model) - one.parameter.ValueIn(options.truth);
    EXPECT_LT(std::abs(error), 2.5 * one.sigma) << one.parameter.name;
    if (one.parameter.kind == CameraParameter::Kind::kDepthTime ||
        one.parameter.kind == CameraParameter::Kind::kDepthPose) {
      EXPECT_TRUE(result.IsCalibrated(one.parameter.name)) << one.parameter.name;
    }
  }
  EXPECT_NEAR(result.model.depth_time, -0.016, 1e-3);
}

TEST(CalibrateCamera, TwoRecordingsOfOneCameraKnowMoreThanOne) {
  const CameraModel truth = ShortRecording(kHandHeld, false, 0).truth;
  CalibrationProblem both = MadeRecording(ShortRecording(kHandHeld, false, 1)).problem();
  const double alone = CalibrateCamera(both, truth, {}).evidence.Find("fx")->bundle_sigma;
  both.Append(MadeRecording(ShortRecording(kPan, false, 2)).problem());
  const double together = CalibrateCamera(both, truth, {}).evidence.Find("fx")->bundle_sigma;
  EXPECT_LT(together, 0.85 * alone);
}

}  // namespace
}  // namespace hullslam
