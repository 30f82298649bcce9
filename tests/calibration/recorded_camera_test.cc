// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/recorded_camera.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <vector>

#include "frame/rolling_shutter.h"
#include "support/synthetic_world.h"
#include "support/test_cameras.h"

namespace hullslam {
namespace {

// The poses of a path with an image every `interval` seconds.
Trajectory PathOf(const SyntheticWorld& world, uint32_t frames) {
  Trajectory trajectory;
  for (uint32_t i = 0; i < frames; ++i) {
    trajectory.push_back(
        {i / world.sensor().frames_per_second, Inverse(SyntheticWorld::CamFromWorld(i))});
  }
  return trajectory;
}

class MapProblem : public testing::TestWithParam<TestCamera> {};

HULLSLAM_WITH_ALL_CAMERAS(MapProblem);

TEST_P(MapProblem, TheResidualsOfATrueMapAreSmall) {
  const SyntheticWorld world({.pixel_noise = 0.3}, GetParam().sensor);
  const SyntheticMap made = MakeSyntheticMap(world, {5, 10, 15, 20, 25, 30});
  const CameraModel model = ModelOf(world.sensor(), {});
  const CalibrationProblem problem =
      MakeProblem(made.map, world.sensor(), model, PathOf(world, 40));
  ASSERT_EQ(problem.views.size(), 6U);
  ASSERT_GT(problem.points.size(), 50U);
  EXPECT_GT(problem.views[2].velocity.linear.norm(), 0.0);
  const CameraAdjustment adjustment(problem, model, {});
  EXPECT_LT(adjustment.MedianError(), 1.0);
}

// Keyframes are few; what other frames saw makes the errors smaller.
TEST(MakeProblem, HasTheFramesBetweenKeyframes) {
  const SyntheticWorld world({}, SyntheticSensor());
  const SyntheticMap made = MakeSyntheticMap(world, {5, 10, 15, 20});
  const CameraModel model = ModelOf(world.sensor(), {});
  const Trajectory path = PathOf(world, 30);
  const Keyframe& keyframe = made.map.keyframes().At(KeyframeId(0));
  SeenView between = SeenViewOf(*keyframe.frame, keyframe.landmarks, world.sensor(), model);
  ASSERT_GT(between.landmarks.size(), 30U);
  const auto at = [&](SeenView view, double frame) {
    view.view.timestamp = frame / world.sensor().frames_per_second;
    return view;
  };
  SeenView weak = at(between, 8);
  weak.landmarks.resize(3);
  const CalibrationProblem without = MakeProblem(made.map, world.sensor(), model, path);
  const CalibrationProblem with =
      MakeProblem(made.map, world.sensor(), model, path,
                  {at(between, 7), weak, at(between, 10), at(between, 7.5)});
  // Frame 8 shows too little, frame 10 is a keyframe, and 7.5 has no pose.
  ASSERT_EQ(without.views.size(), 4U);
  ASSERT_EQ(with.views.size(), 5U);
  EXPECT_EQ(with.views[1].timestamp, at(between, 7).view.timestamp);
  EXPECT_GT(with.views[1].velocity.linear.norm(), 0.0);
  EXPECT_GT(with.CountObservations(), without.CountObservations() + 15);
}

// A map has depths without the offset; what was measured has it.
TEST(MakeProblem, DisparitiesAreThoseThatWereMeasured) {
  const SyntheticWorld world({}, SyntheticSensor());
  // Depths only count where the slope of the surface is known.
  const cv::Mat wall(world.sensor().camera.height, world.sensor().camera.width, CV_16UC1,
                     cv::Scalar(2000));
  const SyntheticMap made =
      MakeSyntheticMap(world, {5, 10, 15, 20},
                       [&](Frame& frame, const Rigid3&) { frame.depth = DepthGrid(wall, 1000.0); });
  const SyntheticMap without_image = MakeSyntheticMap(world, {5, 10, 15, 20});
  const auto problem_with = [&](double offset) {
    return MakeProblem(made.map, world.sensor(),
                       ModelOf(world.sensor(), {.disparity_offset = offset}), PathOf(world, 30));
  };
  const CalibrationProblem without = problem_with(0.0);
  const CalibrationProblem with = problem_with(0.75);
  size_t known = 0;
  for (size_t i = 0; i < without.points.size(); ++i) {
    for (size_t k = 0; k < without.observations[i].size(); ++k) {
      const double disparity = without.observations[i][k].disparity;
      known += disparity > 0.0 ? 1 : 0;
      EXPECT_NEAR(with.observations[i][k].disparity, disparity > 0.0 ? disparity + 0.75 : 0.0,
                  1e-9);
    }
  }
  EXPECT_GT(known, 100U);
  for (const auto& seen : MakeProblem(without_image.map, world.sensor(),
                                      ModelOf(world.sensor(), {}), PathOf(world, 30))
                              .observations) {
    EXPECT_EQ(seen.front().disparity, 0.0);
  }
}

// Single photographs have no velocity, but a lens.
TEST(MakeProblem, ImagesFarApartInTimeHaveNoVelocity) {
  const SyntheticWorld world({}, SyntheticSensor());
  const SyntheticMap made = MakeSyntheticMap(world, {5, 10, 15, 20});
  const CalibrationProblem problem =
      MakeProblem(made.map, world.sensor(), ModelOf(world.sensor(), {}), {});
  ASSERT_EQ(problem.views.size(), 4U);
  EXPECT_EQ(MedianSpeed(problem, ModelOf(world.sensor(), {})), 0.0);
}

// The map has keypoints as a global shutter would have seen them; the camera saw others.
TEST(MakeProblem, RawPixelsAreThoseBeforeTheCorrectionOfTheShutter) {
  Sensor sensor = SyntheticSensor();
  sensor.readout_time = 0.02;
  const SyntheticWorld world({}, SyntheticSensor());
  const PointVelocity velocity{.angular = {0.4, 0.6, -0.3}, .linear = {0.3, 0.1, 0.2}};
  const SyntheticMap as_read = MakeSyntheticMap(world, {5, 10, 15, 20});
  const SyntheticMap corrected =
      MakeSyntheticMap(world, {5, 10, 15, 20}, [&](Frame& frame, const Rigid3&) {
        const std::vector<double> inverse_depths(frame.features.size(), 0.4);
        frame = *WithGlobalShutter(frame, sensor, velocity, inverse_depths);
      });
  const auto problem_of = [&](const SyntheticMap& made) {
    return MakeProblem(made.map, sensor, ModelOf(sensor, {}), PathOf(world, 30));
  };
  const CalibrationProblem expected = problem_of(as_read);
  const CalibrationProblem found = problem_of(corrected);
  ASSERT_EQ(found.CountObservations(), expected.CountObservations());
  for (size_t i = 0; i < expected.points.size(); ++i) {
    for (size_t k = 0; k < expected.observations[i].size(); ++k) {
      EXPECT_LT((found.observations[i][k].raw - expected.observations[i][k].raw).norm(), 1e-2);
      EXPECT_EQ(found.observations[i][k].disparity, expected.observations[i][k].disparity);
    }
  }
}

}  // namespace
}  // namespace hullslam
