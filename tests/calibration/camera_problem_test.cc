// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/camera_problem.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "calibration/made_recording.h"

namespace hullslam {
namespace {

// The minimum of what is left when some views are taken out.
CalibrationProblem Without(const CalibrationProblem& problem, const std::vector<uint8_t>& is_out) {
  CalibrationProblem left = problem;
  left.points.clear();
  left.observations.clear();
  for (size_t i = 0; i < problem.points.size(); ++i) {
    std::vector<CalibrationObservation> seen = problem.observations[i];
    std::erase_if(seen, [&](const auto& one) { return is_out[one.view] != 0; });
    left.points.push_back(problem.points[i]);
    left.observations.push_back(std::move(seen));
  }
  return left;
}

TEST(CameraAdjustment, FindsTheNumbersOfTheCamera) {
  const MadeRecordingOptions options = ShortRecording(kHandHeld, true, 1);
  CameraModel start = options.truth;
  start.camera.fx = start.camera.fy = 530.0;
  start.readout_time = 0.0;
  CameraAdjustment adjustment(MadeRecording(options).problem(), start,
                              ParametersOf(start, {}, true, 300.0));
  const double before = adjustment.cost();
  adjustment.Solve({});
  EXPECT_LT(adjustment.cost(), 0.5 * before);
  EXPECT_NEAR(adjustment.model().camera.fx, 520.0, 2.0);
  EXPECT_NEAR(adjustment.model().readout_time, 0.02, 1e-3);
  // Its noise is that of the sigmas, so the mean squared residual is 1, a little less with the
  // loss.
  EXPECT_NEAR(adjustment.AtMinimum().variance_factor, 0.9, 0.15);
  // A circle of radius 1.18 sigma has half of the errors of two numbers in it; the points took a
  // part.
  EXPECT_NEAR(adjustment.MedianError(), 1.1 * options.pixel_noise, 0.1 * options.pixel_noise);
}

// The jackknife's estimates are those of an adjustment of what is left, to first order.
TEST(CameraAdjustment, StepWithoutViewsIsThatOfANewAdjustment) {
  const MadeRecordingOptions options = ShortRecording(kHandHeld, true, 2);
  const auto parameters = ParametersOf(options.truth, {.distortion = false}, true, 300.0);
  CameraAdjustment all(MadeRecording(options).problem(), options.truth, parameters);
  all.Solve({.tolerance = 1e-12});
  std::vector<uint8_t> is_out(all.problem().views.size(), 0);
  std::fill_n(is_out.begin() + 10, 8, uint8_t{1});
  const Eigen::VectorXd step = all.StepWithout(is_out);
  CameraAdjustment left(Without(all.problem(), is_out), all.model(), parameters);
  left.Solve({.tolerance = 1e-12});
  for (size_t i = 0; i < parameters.size(); ++i) {
    CameraModel moved = all.model();
    parameters[i].Move(step[static_cast<Eigen::Index>(i)], moved);
    const double expected =
        parameters[i].ValueIn(left.model()) - parameters[i].ValueIn(all.model());
    const double found = parameters[i].ValueIn(moved) - parameters[i].ValueIn(all.model());
    EXPECT_NEAR(found, expected, 0.2 * std::abs(expected) + 0.01 * parameters[i].step)
        << parameters[i].name;
  }
}

// Its image may lie anywhere, so it agrees with what was seen there.
TEST(CameraAdjustment, DropsAViewOfAPointInItsOwnCentre) {
  const MadeRecordingOptions options = ShortRecording(kHandHeld, false, 5);
  CalibrationProblem problem = MadeRecording(options).problem();
  const size_t observations = problem.CountObservations();
  const uint32_t view = problem.observations[0][2].view;
  const CalibrationObservation& seen = problem.observations[0][2];
  const Eigen::Vector3d ray =
      options.truth.camera.Unproject(options.truth.camera.Undistort(seen.raw), 1e-6);
  problem.points[0] = Inverse(problem.views[view].cam_from_world) * ray;
  CameraModel start = options.truth;
  start.camera.fx = start.camera.fy = 530.0;
  CameraAdjustment adjustment(problem, start, ParametersOf(start, {}, false, 300.0));
  adjustment.Solve({});
  EXPECT_LT(adjustment.problem().CountObservations(), observations);
  EXPECT_NEAR(adjustment.model().camera.fx, 520.0, 3.0);
}

TEST(CameraAdjustment, AStrongPriorHoldsANumber) {
  const MadeRecordingOptions options = ShortRecording(kHandHeld, false, 3);
  auto parameters = ParametersOf(options.truth, {.distortion = false}, false, 300.0);
  parameters[0].prior_steps = 1e-4;
  parameters[0].expected = 540.0;
  CameraModel start = options.truth;
  start.camera.fx = start.camera.fy = 540.0;
  CameraAdjustment adjustment(MadeRecording(options).problem(), start, parameters);
  adjustment.Solve({});
  EXPECT_NEAR(adjustment.model().camera.fx, 540.0, 0.5);
  EXPECT_NE(adjustment.model().camera.cx, start.camera.cx);
}

TEST(CalibrationProblem, AppendKeepsRecordingsApart) {
  CalibrationProblem both = MadeRecording(ShortRecording(kHandHeld, false, 1)).problem();
  const CalibrationProblem first = both;
  const CalibrationProblem second = MadeRecording(ShortRecording(kPan, false, 2)).problem();
  both.Append(second);
  ASSERT_EQ(both.views.size(), first.views.size() + second.views.size());
  EXPECT_EQ(both.CountObservations(), first.CountObservations() + second.CountObservations());
  EXPECT_EQ(both.views[first.views.size() - 1].recording, 0U);
  EXPECT_EQ(both.views[first.views.size()].recording, 1U);
  EXPECT_EQ(both.observations[first.points.size()][0].view,
            first.views.size() + second.observations[0][0].view);
}

TEST(MedianSpeed, IsThatOfThePixels) {
  const MadeRecordingOptions still = ShortRecording(kNone, false, 1);
  EXPECT_EQ(MedianSpeed(MadeRecording(still).problem(), still.truth), 0.0);
  const MadeRecordingOptions moving = ShortRecording(kHandHeld, false, 1);
  const double speed = MedianSpeed(MadeRecording(moving).problem(), moving.truth);
  EXPECT_GT(speed, 100.0);
  EXPECT_LT(speed, 600.0);
}

}  // namespace
}  // namespace hullslam
