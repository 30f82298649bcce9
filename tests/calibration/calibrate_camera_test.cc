// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/calibrate_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "calibration/determined.h"
#include "calibration/made_recording.h"

namespace hullslam {
namespace {

const MadeMotion kHandHeld;
const MadeMotion kRollOnly{.way = Eigen::Vector3d::Zero(), .turn = {0.0, 0.0, 0.5}};
const MadeMotion kPan{.way = Eigen::Vector3d::Zero(), .turn = {0.3, 0.4, 0.0}};
const MadeMotion kShiftAndRoll{.way = {0.5, 0.3, 0.4}, .turn = {0.0, 0.0, 0.5}};
const MadeMotion kAhead{.way = {0.0, 0.0, 1.0}, .turn = Eigen::Vector3d::Zero()};
const MadeMotion kAlongPlane{.way = {0.5, 0.3, 0.0}, .turn = Eigen::Vector3d::Zero()};
const MadeMotion kNone{.way = Eigen::Vector3d::Zero(), .turn = Eigen::Vector3d::Zero()};

MadeRecordingOptions Options(const MadeMotion& motion, bool has_depth, uint32_t seed) {
  MadeRecordingOptions options{.motion = motion, .truth = MadeCamera(), .has_depth = has_depth};
  options.truth.readout_time = 0.02;
  options.views = 40;
  options.points = 300;
  options.seed = seed;
  return options;
}

CameraEvidence EvidenceOf(const MadeRecordingOptions& options) {
  const MadeRecording recording(options);
  CameraAdjustment adjustment(recording.problem(), options.truth,
                              ParametersOf(options.truth, {}, options.has_depth, 300.0));
  adjustment.Solve({});
  return MeasureEvidence(adjustment);
}

bool Knows(const CameraEvidence& evidence, const std::string& name) {
  const ParameterEvidence* const one = evidence.Find(name);
  return one != nullptr && one->IsDetermined();
}

class Verdicts : public testing::TestWithParam<uint32_t> {};

INSTANTIATE_TEST_SUITE_P(Seeds, Verdicts, testing::Range(0U, 5U));

TEST_P(Verdicts, AHandHeldCameraDeterminesEverything) {
  for (const bool has_depth : {false, true}) {
    const CameraEvidence evidence = EvidenceOf(Options(kHandHeld, has_depth, GetParam()));
    for (const ParameterEvidence& one : evidence.parameters) {
      // The principal point needs more than these 300 points.
      EXPECT_TRUE(one.parameter.IsNuisance() || one.IsDetermined() ||
                  (one.parameter.IsCentring() && one.sigma < 2.0))
          << one.parameter.name << ' ' << one.sigma;
    }
    EXPECT_TRUE(evidence.IsDistortionDetermined());
  }
}

// Translation and turning about the optical axis only: f and the distances go together.
TEST_P(Verdicts, ShiftAndRollDoNotDetermineTheFocalLengthAlsoWithDepth) {
  for (const bool has_depth : {false, true}) {
    const CameraEvidence evidence = EvidenceOf(Options(kShiftAndRoll, has_depth, GetParam()));
    EXPECT_FALSE(Knows(evidence, "fx")) << has_depth;
    EXPECT_TRUE(Knows(evidence, "readout_time")) << has_depth;
  }
}

TEST_P(Verdicts, PureTurningDeterminesTheLensButNoDepth) {
  const CameraEvidence evidence = EvidenceOf(Options(kPan, false, GetParam()));
  EXPECT_TRUE(Knows(evidence, "fx"));
  EXPECT_TRUE(Knows(evidence, "readout_time"));
  EXPECT_TRUE(evidence.IsDistortionDetermined());
}

TEST_P(Verdicts, TurningAboutTheAxisAndStandingStillDetermineNoFocalLengthAndNoDepth) {
  for (const MadeMotion& motion : {kRollOnly, kNone}) {
    const CameraEvidence evidence = EvidenceOf(Options(motion, true, GetParam()));
    EXPECT_FALSE(Knows(evidence, "fx"));
    EXPECT_FALSE(Knows(evidence, "disparity_offset"));
    EXPECT_FALSE(evidence.IsDistortionDetermined());
  }
}

TEST_P(Verdicts, GoingAheadDoesNotDetermineRadialDistortion) {
  const CameraEvidence evidence = EvidenceOf(Options(kAhead, false, GetParam()));
  EXPECT_FALSE(Knows(evidence, "fx"));
  EXPECT_FALSE(evidence.IsDistortionDetermined());
}

TEST_P(Verdicts, APlaneNeedsTiltedViews) {
  MadeRecordingOptions options = Options(kAlongPlane, false, GetParam());
  options.is_plane = true;
  EXPECT_FALSE(Knows(EvidenceOf(options), "fx"));
  options.motion = kHandHeld;
  EXPECT_TRUE(Knows(EvidenceOf(options), "fx"));
}

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

TEST(CalibrateCamera, TwoCamerasAreAContradictionAndStandingStillIsNone) {
  MadeRecordingOptions options = Options(kHandHeld, false, 3);
  const CameraModel first = options.truth;
  CalibrationProblem problem = MadeRecording(options).problem();
  options.truth.camera.fx = options.truth.camera.fy = 900.0;
  options.truth.camera.cx += 60.0;
  options.truth.camera.k1 = 0.3;
  options.truth.readout_time = 0.0;
  options.seed = 4;
  problem.Append(MadeRecording(options).problem());
  CameraAdjustment adjustment(problem, first, ParametersOf(first, {}, options.has_depth, 300.0));
  adjustment.Solve({});
  EXPECT_TRUE(MeasureEvidence(adjustment).IsContradictory())
      << MeasureEvidence(adjustment).jackknife_factor;
  for (const MadeMotion& motion : {kRollOnly, kNone, kShiftAndRoll, kAhead, kPan}) {
    for (const bool has_depth : {false, true}) {
      EXPECT_FALSE(EvidenceOf(Options(motion, has_depth, 0)).IsContradictory())
          << EvidenceOf(Options(motion, has_depth, 0)).jackknife_factor;
    }
  }
}

// The principal point and the tangential distortion replace one another.
TEST(CalibrateCamera, TakesTheAxisOfTheLensAsAWholeOrNotAtAll) {
  MadeRecordingOptions options = Options(kHandHeld, true, 0);
  options.points = 100;
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
    MadeRecordingOptions options = Options(kHandHeld, seed % 2 == 0, seed);
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
    const MadeRecordingOptions options = Options(kHandHeld, seed % 2 == 0, seed);
    const CameraCalibrationResult result =
        CalibrateCamera(MadeRecording(options).problem(), options.truth, {});
    EXPECT_FALSE(result.is_changed) << seed << ' ' << result.evidence_ratio;
    EXPECT_EQ(result.model.camera, options.truth.camera);
  }
}

TEST(CalibrateCamera, KeepsTheFocalLengthOfADepthCameraWithinTheScaleOfDepth) {
  const MadeRecordingOptions options = Options(kHandHeld, true, 1);
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
  const MadeRecordingOptions options = Options(kShiftAndRoll, true, 1);
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

TEST(CalibrateCamera, TwoRecordingsOfOneCameraKnowMoreThanOne) {
  const CameraModel truth = Options(kHandHeld, false, 0).truth;
  CalibrationProblem both = MadeRecording(Options(kHandHeld, false, 1)).problem();
  const double alone = CalibrateCamera(both, truth, {}).evidence.Find("fx")->bundle_sigma;
  both.Append(MadeRecording(Options(kPan, false, 2)).problem());
  const double together = CalibrateCamera(both, truth, {}).evidence.Find("fx")->bundle_sigma;
  EXPECT_LT(together, 0.85 * alone);
}

TEST(AdviceFor, NamesTheMotionThatWouldHelp) {
  const MadeRecordingOptions options = Options(kShiftAndRoll, true, 1);
  const CalibrationProblem problem = MadeRecording(options).problem();
  const MotionSummary motion = SummarizeMotion(problem);
  EXPECT_LT(motion.turn_across, 0.01);
  EXPECT_GT(motion.roll, 0.4);
  EXPECT_GT(motion.way, 0.1);
  const CameraEvidence evidence = EvidenceOf(options);
  EXPECT_NE(AdviceFor(*evidence.Find("fx"), motion).find("left and right"), std::string::npos);
  const MotionSummary still = SummarizeMotion(MadeRecording(Options(kNone, true, 1)).problem());
  EXPECT_NE(AdviceFor(*evidence.Find("fx"), still).find("stood still"), std::string::npos);
}

}  // namespace
}  // namespace hullslam
