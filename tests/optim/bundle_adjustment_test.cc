// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/bundle_adjustment.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "frame/measure_point.h"
#include "map/made_map.h"
#include "map_files/invariants.h"
#include "optim/keypoint_weights.h"
#include "optim/robust.h"
#include "support/pose_distance.h"
#include "support/random_geometry.h"
#include "support/synthetic_world.h"
#include "support/unknown_points.h"

namespace hullslam {
namespace {

// A map of the synthetic world. Perturb moves its points and all but the first two poses away from
// the truth.
class BundleAdjustment : public ::testing::Test {
 protected:
  static constexpr BundleOptions kPrecise{
      .robust_iterations = 20, .final_iterations = 20, .function_tolerance = 1e-14};

  void Perturb(double angle, double distance) {
    for (uint32_t i = 2; i < made_.views.size(); ++i) {
      const Rigid3& pose = made_.map.keyframes().At(KeyframeId(i)).cam_from_world;
      made_.map.SetPose(KeyframeId(i), random_.Pose(angle, distance) * pose);
    }
    for (const LandmarkId id : made_.landmarks) {
      if (id.IsValid()) {
        made_.map.SetPosition(id, made_.map.landmarks().At(id).position + random_.Vector(distance));
      }
    }
  }
  BundleWindow Window() const {
    BundleWindow window;
    window.fixed = KeyframeIds({0, 1});
    window.moving = KeyframeIds({2, 3, 4, 5});
    for (const LandmarkId id : made_.landmarks) {
      if (id.IsValid()) {
        window.landmarks.push_back(id);
      }
    }
    return window;
  }
  // Exchanges the keypoints of `count` pairs of landmarks in `keyframe`. Returns the wrong
  // observations.
  std::set<std::pair<LandmarkId, KeyframeId>> PlantOutliers(KeyframeId keyframe, size_t count) {
    std::set<std::pair<LandmarkId, KeyframeId>> planted;
    for (size_t i = 0; i < count; ++i) {
      const std::vector<LandmarkId> slots = made_.map.keyframes().At(keyframe).landmarks;
      std::vector<uint32_t> used;
      for (uint32_t k = 0; k < slots.size(); ++k) {
        if (slots[k].IsValid() && !planted.contains({slots[k], keyframe}) &&
            made_.map.landmarks().At(slots[k]).observations.size() > 4) {
          used.push_back(k);
        }
      }
      const uint32_t a = used.front();
      const uint32_t b = used[used.size() / 2];
      made_.map.RemoveObservation(slots[a], keyframe);
      made_.map.RemoveObservation(slots[b], keyframe);
      made_.map.AddObservation(slots[a], keyframe, b);
      made_.map.AddObservation(slots[b], keyframe, a);
      planted.insert({slots[a], keyframe});
      planted.insert({slots[b], keyframe});
    }
    return planted;
  }
  // The cost of a landmark at this position in the keyframes of the map, with the loss of the first
  // round.
  double SquaredError(LandmarkId id, const Eigen::Vector3d& position) const {
    double sum = 0.0;
    for (const Observation& seen : made_.map.landmarks().At(id).observations) {
      const Keyframe& keyframe = made_.map.keyframes().At(seen.keyframe);
      const Sensor& sensor = world_.sensor();
      const PointMeasurement measurement = MeasurePoint(
          sensor, keyframe.frame->features, seen.keypoint, sensor.depth_error.ForAdjustment());
      sum += HuberCost(PointChi2(sensor.camera, measurement, keyframe.cam_from_world * position),
                       OutlierBound(measurement));
    }
    return sum;
  }
  double WorstPoseError(const BundleResult& result) const {
    double worst = 0.0;
    for (const auto& [id, pose] : result.poses) {
      worst = std::max(worst, Distance(pose, SyntheticWorld::CamFromWorld(10.0 * id.value)));
    }
    return worst;
  }
  double WorstPointError(const BundleResult& result) const {
    double worst = 0.0;
    for (const auto& [id, position] : result.positions) {
      const auto point = std::find(made_.landmarks.begin(), made_.landmarks.end(), id);
      const auto index = static_cast<size_t>(point - made_.landmarks.begin());
      worst = std::max(worst, (position - world_.points()[index]).norm());
    }
    return worst;
  }

  RandomGeometry random_{1};
  const SyntheticWorld world_{{.points = 300, .depth_share = 0.7}};
  SyntheticMap made_ = MakeSyntheticMap(world_, {0, 10, 20, 30, 40, 50});
};

TEST_F(BundleAdjustment, RecoversTheTruth) {
  Perturb(0.01, 0.03);
  const BundleWindow window = Window();
  const BundleResult result = AdjustBundle(made_.map, world_.sensor(), window, kPrecise, nullptr);
  ASSERT_TRUE(result.is_usable);
  ASSERT_EQ(result.poses.size(), 4u);
  ASSERT_EQ(result.positions.size(), window.landmarks.size());
  // The remaining error comes from rounding the pixels to float.
  EXPECT_LT(WorstPoseError(result), 1e-5);
  EXPECT_LT(WorstPointError(result), 1e-4);
  EXPECT_TRUE(result.outliers.empty());
  EXPECT_GT(result.residuals, 1000);
}

TEST_F(BundleAdjustment, DefaultOptionsComeNearTheTruth) {
  Perturb(0.01, 0.03);
  const BundleResult result = AdjustBundle(made_.map, world_.sensor(), Window(), {}, nullptr);
  ASSERT_TRUE(result.is_usable);
  EXPECT_LT(WorstPoseError(result), 1e-3);
  EXPECT_LE(result.iterations, 5 + 10 + 2);  // Ceres counts the start of each round
}

TEST_F(BundleAdjustment, StaysAtTheTruth) {
  const BundleResult result = AdjustBundle(made_.map, world_.sensor(), Window(), kPrecise, nullptr);
  ASSERT_TRUE(result.is_usable);
  EXPECT_LT(WorstPoseError(result), 1e-5);
  EXPECT_TRUE(result.outliers.empty());
}

TEST_F(BundleAdjustment, FindsExactlyTheWrongObservations) {
  const auto planted = PlantOutliers(KeyframeId(3), 10);
  ASSERT_EQ(planted.size(), 20u);
  ASSERT_TRUE(FindViolations(made_.map).empty());
  Perturb(0.005, 0.02);
  const BundleResult result = AdjustBundle(made_.map, world_.sensor(), Window(), kPrecise, nullptr);
  ASSERT_TRUE(result.is_usable);
  EXPECT_EQ(
      (std::set<std::pair<LandmarkId, KeyframeId>>(result.outliers.begin(), result.outliers.end())),
      planted);
  EXPECT_LT(WorstPoseError(result), 1e-5);
  EXPECT_LT(WorstPointError(result), 1e-4);
}

// No pose moves. Without the robust loss of the first round, a wrong observation would move its
// point so far that right observations became outliers too.
TEST_F(BundleAdjustment, FindsExactlyTheWrongObservationsOfFixedPosesToo) {
  const auto planted = PlantOutliers(KeyframeId(3), 10);
  BundleWindow window = Window();
  window.fixed.insert(window.fixed.end(), window.moving.begin(), window.moving.end());
  window.moving.clear();
  const BundleResult result = AdjustBundle(made_.map, world_.sensor(), window, kPrecise, nullptr);
  ASSERT_TRUE(result.is_usable);
  EXPECT_EQ(
      (std::set<std::pair<LandmarkId, KeyframeId>>(result.outliers.begin(), result.outliers.end())),
      planted);
  EXPECT_LT(WorstPointError(result), 1e-4);
}

// The bound is 2.4 standard deviations of the remaining error without depth, and 2.8 with depth.
TEST_F(BundleAdjustment, AnObservationIsAnOutlierFromAFewStandardDeviationsOn) {
  constexpr uint32_t kShifted = 20;  // keypoint
  for (const float deviations : {1.5f, 6.0f}) {
    made_ = MakeSyntheticMap(world_, {0, 10, 20, 30, 40, 50}, [&](Frame& frame, const Rigid3&) {
      if (frame.id.value == 30) {
        Keypoint& keypoint = frame.features.keypoints[kShifted];
        const auto level = static_cast<size_t>(keypoint.level);
        keypoint.undistorted.y() += deviations * world_.sensor().levels.scale[level];
      }
    });
    const BundleResult result =
        AdjustBundle(made_.map, world_.sensor(), Window(), kPrecise, nullptr);
    ASSERT_TRUE(result.is_usable);
    if (deviations < 2.0f) {
      EXPECT_TRUE(result.outliers.empty());
    } else {
      ASSERT_EQ(result.outliers.size(), 1u);
      EXPECT_EQ(result.outliers[0].first,
                made_.map.keyframes().At(KeyframeId(3)).landmarks[kShifted]);
      EXPECT_EQ(result.outliers[0].second, KeyframeId(3));
    }
  }
}

// The error is two standard deviations of the sensor, but seven of the real errors of the
// keypoints.
TEST_F(BundleAdjustment, MonocularErrorsAreComparedWithThoseOfTheOtherKeypoints) {
  constexpr uint32_t kShifted = 20;  // keypoint
  const SyntheticWorld world({.points = 300, .pixel_noise = 0.3, .depth_share = 0.0});
  made_ = MakeSyntheticMap(world, {0, 10, 20, 30, 40, 50}, [&](Frame& frame, const Rigid3&) {
    if (frame.id.value == 30) {
      Keypoint& keypoint = frame.features.keypoints[kShifted];
      const auto level = static_cast<size_t>(keypoint.level);
      keypoint.undistorted.y() += 2.0f * world.sensor().levels.scale[level];
    }
  });
  Sensor sensor = world.sensor();
  EXPECT_TRUE(AdjustBundle(made_.map, sensor, Window(), kPrecise, nullptr).outliers.empty());
  sensor.kind = SensorKind::kMonocular;
  const BundleResult result = AdjustBundle(made_.map, sensor, Window(), kPrecise, nullptr);
  ASSERT_TRUE(result.is_usable);
  const std::pair shifted(made_.map.keyframes().At(KeyframeId(3)).landmarks[kShifted],
                          KeyframeId(3));
  EXPECT_EQ(std::count(result.outliers.begin(), result.outliers.end(), shifted), 1);
  EXPECT_LT(result.outliers.size(), static_cast<size_t>(result.residuals) / 50);
}

// The measured standard deviation is at least a fifth of that of the sensor. Otherwise exact
// keypoints would become outliers because they are rounded.
TEST_F(BundleAdjustment, MonocularExactKeypointsAreNoOutliers) {
  Sensor sensor = world_.sensor();
  sensor.kind = SensorKind::kMonocular;
  Perturb(0.002, 0.005);
  const BundleResult result = AdjustBundle(made_.map, sensor, Window(), kPrecise, nullptr);
  ASSERT_TRUE(result.is_usable);
  EXPECT_TRUE(result.outliers.empty());
  EXPECT_LT(WorstPoseError(result), 1e-4);
}

// Where an edge passes behind another, there is a corner that slides along both. It is found at
// several levels of the pyramid, so that it makes several landmarks.
TEST_F(BundleAdjustment, MonocularACornerThatIsFoundSeveralTimesCountsOnce) {
  const SyntheticWorld world({.points = 60, .pixel_noise = 0.1, .depth_share = 0.0});
  Sensor sensor = world.sensor();
  sensor.kind = SensorKind::kMonocular;
  const auto error_with_copies = [&](uint32_t copies, size_t max_dense) {
    made_ = MakeSyntheticMap(
        world, {0, 10, 20, 30, 40, 50}, [&](Frame& frame, const Rigid3& cam_from_world) {
          const double slide = 0.1 * std::pow(frame.id.value / 50.0, 2.0);
          const Eigen::Vector3d corner(slide, 0.3, 3.0);
          for (uint32_t i = 0; i < copies; ++i) {
            frame.features.keypoints.push_back(
                {.undistorted = sensor.camera.Project(cam_from_world * corner).cast<float>()});
            frame.features.descriptors.push_back(world.descriptor(i));
            frame.features.depth.push_back(0.0f);
          }
          RebuildGrid(sensor, frame);
        });
    BundleWindow window = Window();
    for (uint32_t i = 0; i < copies; ++i) {
      const LandmarkId id = made_.map.AddLandmark({0.1, 0.3, 3.0}, KeyframeId(0));
      for (uint32_t k = 0; k < made_.views.size(); ++k) {
        const auto first = static_cast<uint32_t>(made_.views[k].points.size());
        made_.map.AddObservation(id, KeyframeId(k), first + i);
      }
      window.landmarks.push_back(id);
    }
    BundleOptions options = kPrecise;
    options.max_dense = max_dense;
    const BundleResult result = AdjustBundle(made_.map, sensor, window, options, nullptr);
    EXPECT_TRUE(result.is_usable);
    return WorstPoseError(result);
  };
  for (const size_t max_dense : {0U, 100U}) {  // both ways to solve it
    // If each landmark counted, the poses would be wrong by decimetres.
    EXPECT_LT(error_with_copies(8, max_dense), 1.2 * error_with_copies(0, max_dense));
  }
}

// The result is a minimum of Cauchy's loss, so a Newton step of a point from its position has no
// length.
TEST_F(BundleAdjustment, MonocularCauchysLossIsMinimised) {
  // There is so much noise that the measured precision of the keypoints is that of the sensor.
  const SyntheticWorld world({.points = 300, .pixel_noise = 1.2, .depth_share = 0.0});
  Sensor sensor = world.sensor();
  sensor.kind = SensorKind::kMonocular;
  for (const size_t max_dense : {0U, 100U}) {  // both ways to solve it
    made_ = MakeSyntheticMap(world, {0, 10, 20, 30, 40, 50});
    BundleOptions options = kPrecise;
    options.max_dense = max_dense;
    const BundleResult result = AdjustBundle(made_.map, sensor, Window(), options, nullptr);
    ASSERT_TRUE(result.is_usable);
    const Map start = made_.map.Snapshot();  // with all observations, also those at the same pixels
    ApplyBundle(made_.map, result, sensor.levels);
    const auto cost = [&](LandmarkId id, const Eigen::Vector3d& position) {
      double sum = 0.0;
      for (const Observation& seen : made_.map.landmarks().At(id).observations) {
        const Keyframe& keyframe = made_.map.keyframes().At(seen.keyframe);
        const PointMeasurement measurement = MeasurePoint(
            sensor, keyframe.frame->features, seen.keypoint, sensor.depth_error.ForAdjustment());
        sum += internal::KeypointWeights(start.keyframes().At(seen.keyframe),
                                         sensor.levels)[seen.keypoint] *
               CauchyCost(PointChi2(sensor.camera, measurement, keyframe.cam_from_world * position),
                          kCauchyScale);
      }
      return sum;
    };
    std::set<LandmarkId> with_outliers;
    for (const auto& [id, keyframe] : result.outliers) {
      with_outliers.insert(id);
    }
    double longest = 0.0;
    EXPECT_LT(with_outliers.size() + 50, result.positions.size());
    for (const auto& [id, position] : result.positions) {
      if (with_outliers.contains(id)) {
        continue;
      }
      const Eigen::Vector3d step(0.0, 1e-4, 0.0);
      const double before = cost(id, position - step);
      const double after = cost(id, position + step);
      const double curvature = before + after - 2.0 * cost(id, position);
      longest = std::max(longest, 0.5 * std::abs(after - before) / curvature * step.y());
    }
    EXPECT_LT(longest, 1e-6) << max_dense;
  }
}

TEST_F(BundleAdjustment, APointBehindACameraIsAnOutlierThere) {
  const LandmarkId id = Window().landmarks[5];
  const Landmark& landmark = made_.map.landmarks().At(id);
  const size_t observations = landmark.observations.size();
  made_.map.SetPosition(id, {0.0, 0.0, -5.0});
  const BundleResult result = AdjustBundle(made_.map, world_.sensor(), Window(), kPrecise, nullptr);
  ASSERT_TRUE(result.is_usable);
  EXPECT_EQ(result.outliers.size(), observations);
  for (const auto& [outlier, keyframe] : result.outliers) {
    EXPECT_EQ(outlier, id);
  }
}

// On the way to its true pose a camera passes a point that only this camera sees. There the cost of
// the point is not defined, and this must not stop the camera of a large map.
TEST_F(BundleAdjustment, APointThatACameraGoesPastDoesNotHoldIt) {
  const KeyframeId id(5);
  const Rigid3 truth = made_.map.CamFromWorld(id);
  const Rigid3 behind = Rigid3(Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.05}) * truth;
  made_.map.SetPose(id, behind);
  BundleWindow window = Window();
  window.fixed = KeyframeIds({0, 1, 2});
  window.moving = {id};
  const Keyframe& keyframe = made_.map.keyframes().At(id);
  Sensor sensor = world_.sensor();
  sensor.kind = SensorKind::kMonocular;
  uint32_t keypoint = 0;  // keypoint of a landmark without depth that all keyframes see
  while (MeasurePoint(sensor, keyframe.frame->features, keypoint, sensor.depth_error).has_depth() ||
         !keyframe.landmarks[keypoint].IsValid() ||
         made_.map.landmarks().At(keyframe.landmarks[keypoint]).observations.size() <
             made_.views.size()) {
    ASSERT_LT(++keypoint, keyframe.landmarks.size());
  }
  const LandmarkId landmark = keyframe.landmarks[keypoint];
  for (const KeyframeId other : window.fixed) {
    made_.map.RemoveObservation(landmark, other);
  }
  const Eigen::Vector2d pixel =
      keyframe.frame->features.keypoints[keypoint].undistorted.cast<double>();
  made_.map.SetPosition(landmark, Inverse(behind) * sensor.camera.Unproject(pixel, 0.002));
  BundleOptions options = kPrecise;
  options.max_dense = 0;
  const BundleResult result = AdjustBundle(made_.map, sensor, window, options, nullptr);
  ASSERT_TRUE(result.is_usable);
  EXPECT_LT(WorstPoseError(result), 1e-3);
}

TEST_F(BundleAdjustment, DoesNotChangeTheMap) {
  Perturb(0.01, 0.03);
  const std::string before = Dump(made_.map);
  AdjustBundle(made_.map, world_.sensor(), Window(), {}, nullptr);
  EXPECT_EQ(Dump(made_.map), before);
}

TEST_F(BundleAdjustment, SameInputGivesTheSameBits) {
  Perturb(0.01, 0.03);
  const BundleResult first = AdjustBundle(made_.map, world_.sensor(), Window(), {}, nullptr);
  const BundleResult second = AdjustBundle(made_.map, world_.sensor(), Window(), {}, nullptr);
  ASSERT_EQ(first.poses.size(), second.poses.size());
  for (size_t i = 0; i < first.poses.size(); ++i) {
    EXPECT_EQ(first.poses[i].second.rotation.coeffs(), second.poses[i].second.rotation.coeffs());
    EXPECT_EQ(first.poses[i].second.translation, second.poses[i].second.translation);
  }
  EXPECT_EQ(first.positions, second.positions);
  EXPECT_EQ(first.outliers, second.outliers);
}

// 149 poses are too many for the dense solver. CHOLMOD solves their system, and the thread
// sanitizer cannot follow its OpenMP threads.
TEST_F(BundleAdjustment, WithManyPosesRecoversTheTruthAndGivesTheSameBits) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP();
#endif
  for (const auto& [count, step] : std::vector<std::pair<uint32_t, uint32_t>>{{70, 2}, {150, 1}}) {
    const SyntheticWorld world({.points = 120, .depth_share = 0.7});
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < count; ++i) {
      indices.push_back(step * i);
    }
    SyntheticMap made = MakeSyntheticMap(world, indices);
    for (uint32_t i = 1; i < count; ++i) {
      const Rigid3& pose = made.map.keyframes().At(KeyframeId(i)).cam_from_world;
      made.map.SetPose(KeyframeId(i), random_.Pose(0.01, 0.02) * pose);
    }
    const BundleWindow window = GlobalWindow(made.map, IslandId(0));
    ASSERT_EQ(window.moving.size(), count - 1);
    const BundleResult first = AdjustBundle(made.map, world.sensor(), window, kPrecise, nullptr);
    const BundleResult second = AdjustBundle(made.map, world.sensor(), window, kPrecise, nullptr);
    ASSERT_TRUE(first.is_usable);
    for (size_t i = 0; i < first.poses.size(); ++i) {
      const auto& [id, pose] = first.poses[i];
      EXPECT_LT(Distance(pose, SyntheticWorld::CamFromWorld(1.0 * step * id.value)), 1e-4);
      EXPECT_EQ(pose.translation, second.poses[i].second.translation);
      EXPECT_EQ(pose.rotation.coeffs(), second.poses[i].second.rotation.coeffs());
    }
    EXPECT_EQ(first.positions, second.positions);
  }
}

TEST_F(BundleAdjustment, ASparseSystemComesToTheSameResult) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the thread sanitizer cannot follow the OpenMP threads of CHOLMOD";
#endif
  const SyntheticWorld world({.points = 300, .pixel_noise = 1.0, .depth_share = 0.7});
  const SyntheticMap made = MakeSyntheticMap(world, {0, 10, 20, 30, 40, 50});
  const BundleWindow window = GlobalWindow(made.map, IslandId(0));
  BundleOptions options = kPrecise;
  const BundleResult dense = AdjustBundle(made.map, world.sensor(), window, options, nullptr);
  options.max_dense = window.moving.size() - 1;
  const BundleResult sparse = AdjustBundle(made.map, world.sensor(), window, options, nullptr);
  ASSERT_EQ(dense.poses.size(), sparse.poses.size());
  double moved = 0.0;
  for (size_t i = 0; i < dense.poses.size(); ++i) {
    EXPECT_LT(Distance(dense.poses[i].second, sparse.poses[i].second), 1e-6);
    moved += Distance(dense.poses[i].second,
                      made.map.keyframes().At(dense.poses[i].first).cam_from_world);
  }
  EXPECT_GT(moved, 1e-3);
  EXPECT_EQ(dense.outliers, sparse.outliers);
  EXPECT_NE(dense.positions, sparse.positions) << "the last bits show that the solvers differ";
}

// Outliers can only be told after the errors were minimised.
TEST_F(BundleAdjustment, CancelledAtOnceItReturnsTheStartWithoutOutliers) {
  Perturb(0.01, 0.03);
  Cancellation cancellation;
  cancellation.Request();
  const BundleResult result =
      AdjustBundle(made_.map, world_.sensor(), Window(), kPrecise, &cancellation);
  ASSERT_TRUE(result.is_usable);
  EXPECT_EQ(result.iterations, 1);  // the evaluation of the start
  EXPECT_TRUE(result.outliers.empty());
  ASSERT_EQ(result.poses.size(), 4u);
  for (const auto& [id, pose] : result.poses) {
    EXPECT_LT(Distance(pose, made_.map.keyframes().At(id).cam_from_world), 1e-14);
  }
  // The points may have moved to fit the initial poses.
  for (const auto& [id, position] : result.positions) {
    EXPECT_LE(SquaredError(id, position),
              SquaredError(id, made_.map.landmarks().At(id).position) * (1.0 + 1e-9));
  }
}

TEST_F(BundleAdjustment, TellsAfterEachIterationHowManyAreDone) {
  Perturb(0.01, 0.03);
  std::vector<int> done;
  const BundleOptions options;
  const int most = options.robust_iterations + options.final_iterations;
  const BundleResult result = AdjustBundle(made_.map, world_.sensor(), Window(), options, nullptr,
                                           [&](int iteration, int of) {
                                             EXPECT_EQ(of, most);
                                             done.push_back(iteration);
                                           });
  ASSERT_FALSE(done.empty());
  for (size_t i = 0; i < done.size(); ++i) {
    EXPECT_EQ(done[i], static_cast<int>(i) + 1);
  }
  EXPECT_EQ(done.back(), result.iterations - 2);  // the iterations also count the two starts
  EXPECT_LE(done.back(), most);
}

TEST_F(BundleAdjustment, ACancellationThatIsNotRequestedChangesNothing) {
  Perturb(0.01, 0.03);
  const Cancellation cancellation;
  const BundleResult with = AdjustBundle(made_.map, world_.sensor(), Window(), {}, &cancellation);
  const BundleResult without = AdjustBundle(made_.map, world_.sensor(), Window(), {}, nullptr);
  EXPECT_EQ(with.positions, without.positions);
  EXPECT_EQ(with.iterations, without.iterations);
}

TEST_F(BundleAdjustment, OfAnEmptyWindowIsEmpty) {
  const BundleResult nothing = AdjustBundle(made_.map, world_.sensor(), {}, {}, nullptr);
  EXPECT_TRUE(nothing.poses.empty());
  EXPECT_TRUE(nothing.positions.empty());
  // Keyframes that see nothing stay where they are.
  const BundleWindow window{
      .moving = KeyframeIds({3}), .fixed = KeyframeIds({0}), .landmarks = {}, .objects = {}};
  const BundleResult idle = AdjustBundle(made_.map, world_.sensor(), window, {}, nullptr);
  for (const auto& [id, pose] : idle.poses) {
    EXPECT_LT(Distance(pose, made_.map.keyframes().At(id).cam_from_world), 1e-14);
  }
}

#ifndef __SANITIZE_ADDRESS__
// The resident memory of this process, bytes.
size_t Resident() {
  size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages >> pages;
  return pages * static_cast<size_t>(sysconf(_SC_PAGESIZE));
}

// A global adjustment needs much memory, so free memory between used blocks is given back before.
TEST_F(BundleAdjustment, OfAnIslandGivesFreeMemoryBack) {
  constexpr size_t kBlocks = 1000;
  constexpr size_t kBytes = 60'000;
  std::vector<std::vector<char>> blocks;
  for (size_t i = 0; i < kBlocks; ++i) {
    blocks.emplace_back(kBytes, 'x');
  }
  for (size_t i = 0; i < kBlocks; i += 2) {
    blocks[i] = std::vector<char>();
  }
  const size_t before = Resident();
  AdjustIsland(made_.map, IslandId(0), world_.sensor(), {}, nullptr);
  EXPECT_LT(Resident() + kBlocks / 4 * kBytes, before);
}
#endif

}  // namespace

}  // namespace hullslam
