// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/determined.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "calibration/made_recording.h"

namespace hullslam {
namespace {

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
    const CameraEvidence evidence = EvidenceOf(ShortRecording(kHandHeld, has_depth, GetParam()));
    for (const ParameterEvidence& one : evidence.parameters) {
      // The principal point and the pose of depth images need more than these 300 points.
      EXPECT_TRUE(
          one.parameter.IsNuisance() || one.IsDetermined() ||
          (one.parameter.IsCentring() && one.sigma < 2.0) ||
          (one.parameter.kind == CameraParameter::Kind::kDepthPose && one.sigma < 2.0 * one.bound))
          << one.parameter.name << ' ' << one.sigma;
    }
    EXPECT_TRUE(evidence.IsDistortionDetermined());
  }
}

// Translation and turning about the optical axis only: f and the distances go together.
TEST_P(Verdicts, ShiftAndRollDoNotDetermineTheFocalLengthAlsoWithDepth) {
  for (const bool has_depth : {false, true}) {
    const CameraEvidence evidence =
        EvidenceOf(ShortRecording(kShiftAndRoll, has_depth, GetParam()));
    EXPECT_FALSE(Knows(evidence, "fx")) << has_depth;
    EXPECT_TRUE(Knows(evidence, "readout_time")) << has_depth;
  }
}

TEST_P(Verdicts, PureTurningDeterminesTheLensButNoDepth) {
  const CameraEvidence evidence = EvidenceOf(ShortRecording(kPan, false, GetParam()));
  EXPECT_TRUE(Knows(evidence, "fx"));
  EXPECT_TRUE(Knows(evidence, "readout_time"));
  EXPECT_TRUE(evidence.IsDistortionDetermined());
}

TEST_P(Verdicts, TurningAboutTheAxisAndStandingStillDetermineNoFocalLengthAndNoDepth) {
  for (const MadeMotion& motion : {kRollOnly, kNone}) {
    const CameraEvidence evidence = EvidenceOf(ShortRecording(motion, true, GetParam()));
    EXPECT_FALSE(Knows(evidence, "fx"));
    EXPECT_FALSE(Knows(evidence, "disparity_offset"));
    EXPECT_FALSE(evidence.IsDistortionDetermined());
  }
}

TEST_P(Verdicts, GoingAheadDoesNotDetermineRadialDistortion) {
  const CameraEvidence evidence = EvidenceOf(ShortRecording(kAhead, false, GetParam()));
  EXPECT_FALSE(Knows(evidence, "fx"));
  EXPECT_FALSE(evidence.IsDistortionDetermined());
}

TEST_P(Verdicts, APlaneNeedsTiltedViews) {
  MadeRecordingOptions options = ShortRecording(kAlongPlane, false, GetParam());
  options.is_plane = true;
  EXPECT_FALSE(Knows(EvidenceOf(options), "fx"));
  options.motion = kHandHeld;
  EXPECT_TRUE(Knows(EvidenceOf(options), "fx"));
}

TEST(MeasureEvidence, TwoCamerasAreAContradictionAndStandingStillIsNone) {
  MadeRecordingOptions options = ShortRecording(kHandHeld, false, 3);
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
      EXPECT_FALSE(EvidenceOf(ShortRecording(motion, has_depth, 0)).IsContradictory())
          << EvidenceOf(ShortRecording(motion, has_depth, 0)).jackknife_factor;
    }
  }
}

// A stabilised video is a window that moves in the images.
TEST(MeasureEvidence, AWindowThatMovesIsAContradiction) {
  MadeRecordingOptions options = ShortRecording(kHandHeld, false, 3);
  options.views = 60;
  options.points = 500;
  CalibrationProblem problem = MadeRecording(options).problem();
  for (std::vector<CalibrationObservation>& observations : problem.observations) {
    for (CalibrationObservation& seen : observations) {
      const double time = problem.views[seen.view].timestamp;
      seen.raw += Eigen::Vector2d(30.0 * std::sin(3.9 * time), 22.0 * std::sin(5.1 * time + 1.0));
    }
  }
  CameraAdjustment adjustment(problem, options.truth,
                              ParametersOf(options.truth, {}, false, 300.0));
  adjustment.Solve({});
  EXPECT_TRUE(MeasureEvidence(adjustment).IsContradictory())
      << MeasureEvidence(adjustment).jackknife_factor;
}

TEST(AdviceFor, NamesTheMotionThatWouldHelp) {
  const MadeRecordingOptions options = ShortRecording(kShiftAndRoll, true, 1);
  const CalibrationProblem problem = MadeRecording(options).problem();
  const MotionSummary motion = SummarizeMotion(problem);
  EXPECT_LT(motion.turn_across, 0.01);
  EXPECT_GT(motion.roll, 0.4);
  EXPECT_GT(motion.way, 0.1);
  const CameraEvidence evidence = EvidenceOf(options);
  EXPECT_NE(AdviceFor(*evidence.Find("fx"), motion).find("left and right"), std::string::npos);
  const MotionSummary still =
      SummarizeMotion(MadeRecording(ShortRecording(kNone, true, 1)).problem());
  EXPECT_NE(AdviceFor(*evidence.Find("fx"), still).find("stood still"), std::string::npos);
}

}  // namespace
}  // namespace hullslam
