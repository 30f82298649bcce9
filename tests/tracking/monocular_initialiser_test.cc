// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/monocular_initialiser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "support/synthetic_world.h"

namespace hullslam {
namespace {

class MonocularStart : public testing::Test {
 protected:
  MonocularStart() { sensor_.kind = SensorKind::kMonocular; }

  // Gives the frames `begin`, `begin` + 1, ... of the path to the initialiser until there is a map;
  // at most `most` frames.
  std::optional<InitialMap> Walk(MonocularInitialiser& initialiser, uint32_t begin, uint32_t most) {
    for (uint32_t i = begin; i < begin + most; ++i) {
      if (auto result = Give(initialiser, i, SyntheticWorld::CamFromWorld(i)); result.map) {
        return std::move(result.map);
      }
    }
    return std::nullopt;
  }
  MonocularInitialiser::Result Give(MonocularInitialiser& initialiser, uint32_t id,
                                    const Rigid3& cam_from_world) {
    SyntheticView view = world_.Observe(FrameId(id), cam_from_world);
    truth_[id] = cam_from_world;
    points_[id] = view.points;
    MonocularInitialiser::Result result = initialiser.Process(view.frame);
    if (!result.map) {
      ++failures_[result.failure];
    }
    return result;
  }
  // Expects poses that are right up to the scale. Errors are shares of the length of the path.
  void ExpectRight(const InitialMap& map) {
    const Rigid3 world_from_first = Inverse(truth_.at(map.views.front().frame->id.value));
    const auto truth_of = [&](const InitialMap::View& view) {
      return truth_.at(view.frame->id.value) * world_from_first;
    };
    const double way = truth_of(map.views.back()).translation.norm();
    const double scale = way / map.views.back().cam_from_world.translation.norm();
    for (const InitialMap::View& view : map.views) {
      const Rigid3 truth = truth_of(view);
      EXPECT_LT(AngularDistance(view.cam_from_world.rotation, truth.rotation), 0.01);
      EXPECT_LT((scale * view.cam_from_world.translation - truth.translation).norm(), 0.15 * way);
    }
  }
  static double MedianDepth(const InitialMap& map) {
    std::vector<double> depths;
    for (const InitialMap::Point& point : map.points) {
      depths.push_back(point.position.z());
    }
    std::sort(depths.begin(), depths.end());
    return depths[depths.size() / 2];
  }

  // The median distance (px) of the keypoints that show the same points.
  static double MedianShift(const SyntheticView& one, const SyntheticView& other) {
    std::vector<double> shifts;
    for (size_t i = 0, k = 0; i < one.points.size() && k < other.points.size();) {
      if (one.points[i] != other.points[k]) {
        ++(one.points[i] < other.points[k] ? i : k);
        continue;
      }
      const auto& here = one.frame->features.keypoints[i++].undistorted;
      const auto& there = other.frame->features.keypoints[k++].undistorted;
      shifts.push_back(static_cast<double>((here - there).norm()));
    }
    std::sort(shifts.begin(), shifts.end());
    return shifts[shifts.size() / 2];
  }

  const SyntheticWorld world_{{.points = 400, .depth_share = 0.0}};
  Sensor sensor_ = world_.sensor();
  std::map<uint32_t, Rigid3> truth_;                  // by frame
  std::map<uint32_t, std::vector<uint32_t>> points_;  // points that the keypoints of a frame show
  std::map<InitialisationFailure, int> failures_;
};

TEST_F(MonocularStart, MakesAMapOfTheFirstFramesWithParallax) {
  MonocularInitialiser initialiser(sensor_, 1);
  const auto map = Walk(initialiser, 0, 30);
  ASSERT_TRUE(map);
  EXPECT_GE(map->views.size(), 3U);  // frames in between confirm it
  EXPECT_EQ(map->views.front().cam_from_world.ToMatrix(), Rigid3().ToMatrix());
  EXPECT_TRUE(
      std::is_sorted(map->views.begin(), map->views.end(),
                     [](const auto& a, const auto& b) { return a.frame->id < b.frame->id; }));
  EXPECT_NEAR(MedianDepth(*map), 1.0, 1e-9);
  EXPECT_GE(map->points.size(), 100U);
  ExpectRight(*map);
}

TEST_F(MonocularStart, AllObservationsOfAPointShowThePoint) {
  MonocularInitialiser initialiser(sensor_, 1);
  const auto map = Walk(initialiser, 0, 30);
  ASSERT_TRUE(map);
  size_t wrong = 0;
  for (const InitialMap::Point& point : map->points) {
    ASSERT_GE(point.observations.size(), 2U);
    const auto shown = [&](const InitialMap::Observation& seen) {
      return points_.at(map->views[seen.view].frame->id.value)[seen.keypoint];
    };
    for (const InitialMap::Observation& seen : point.observations) {
      wrong += shown(seen) == shown(point.observations.front()) ? 0 : 1;
    }
  }
  EXPECT_EQ(wrong, 0U);
}

// With few images per second, an image shows little of those before the last one. So each one is a
// reference, although with 30 images per second every third one is enough. The first image is a
// reference that shows nothing of the others.
TEST_F(MonocularStart, TheIntervalOfReferencesIsATime) {
  const SyntheticWorld other({.points = 400, .depth_share = 0.0, .seed = 77});
  for (const auto& [rate, reference] : {std::pair(5.0, 1U), std::pair(30.0, 3U)}) {
    sensor_.frames_per_second = rate;
    MonocularInitialiser initialiser(sensor_, 1);
    EXPECT_FALSE(initialiser.Process(other.Observe(0).frame).map);
    const auto map = Walk(initialiser, 1, 30);
    ASSERT_TRUE(map);
    EXPECT_EQ(map->views.front().frame->id, FrameId(reference));
  }
}

// A camera that stood still for long has many images without parallax behind it.
TEST_F(MonocularStart, ALongWaitDoesNoHarm) {
  MonocularInitialiser initialiser(sensor_, 1);
  for (uint32_t i = 0; i < 90; ++i) {
    EXPECT_FALSE(Give(initialiser, i, SyntheticWorld::CamFromWorld(90)).map);
  }
  const auto map = Walk(initialiser, 90, 30);
  ASSERT_TRUE(map);
  ExpectRight(*map);
  EXPECT_GE(failures_[InitialisationFailure::kTooLittleParallax], 89);
}

// The first image shows another scene, and the last image before has too little parallax. So an
// image in between must have been kept.
TEST_F(MonocularStart, ImagesBetweenTheFirstAndTheLastAreKept) {
  const SyntheticWorld other({.points = 400, .depth_share = 0.0, .seed = 10});
  MonocularInitialiser initialiser(sensor_, 1);
  EXPECT_FALSE(initialiser.Process(other.Observe(0).frame).map);
  std::optional<InitialMap> map;
  for (uint32_t i = 3; i < 60 && !map; ++i) {
    map = Give(initialiser, i, SyntheticWorld::CamFromWorld(0.5 * i)).map;
  }
  ASSERT_TRUE(map);
  EXPECT_GT(map->views.front().frame->id, FrameId(0));
  ExpectRight(*map);
}

TEST_F(MonocularStart, ARotationGivesNoMap) {
  for (uint64_t seed = 0; seed < 10; ++seed) {
    MonocularInitialiser initialiser(sensor_, seed);
    for (uint32_t i = 0; i < 40; ++i) {
      const double angle = 0.012 * i;
      const Rigid3 turned(ExpSo3({0.2 * angle, angle, 0.1 * angle}), Eigen::Vector3d::Zero());
      EXPECT_FALSE(Give(initialiser, static_cast<uint32_t>(100 * seed) + i, turned).map)
          << seed << ", " << i;
    }
  }
  EXPECT_GT(failures_[InitialisationFailure::kTooLittleParallax], 300);
}

// Two images would be enough for a map. The image between them has the same features at other
// pixels.
TEST_F(MonocularStart, AFrameInBetweenThatDoesNotFitPreventsTheMap) {
  const auto give_three = [&](bool is_strange) {
    MonocularInitialiser initialiser(sensor_, 1);
    EXPECT_FALSE(Give(initialiser, 0, SyntheticWorld::CamFromWorld(0)).map);
    auto between = std::make_shared<Frame>(
        *world_.Observe(FrameId(10), SyntheticWorld::CamFromWorld(1)).frame);
    if (is_strange) {
      std::vector<Keypoint>& keypoints = between->features.keypoints;
      for (size_t i = 0; i < keypoints.size() / 2; ++i) {
        std::swap(keypoints[i].undistorted, keypoints[keypoints.size() - 1 - i].undistorted);
      }
    }
    EXPECT_FALSE(initialiser.Process(between).map);
    return Give(initialiser, 20, SyntheticWorld::CamFromWorld(20));
  };
  const MonocularInitialiser::Result good = give_three(false);
  ASSERT_TRUE(good.map);
  EXPECT_EQ(good.map->views.size(), 3U);
  const MonocularInitialiser::Result bad = give_three(true);
  EXPECT_FALSE(bad.map);
  EXPECT_EQ(bad.failure, InitialisationFailure::kNotConfirmed);
}

std::shared_ptr<const Frame> WithStamp(const SyntheticView& view, double timestamp) {
  auto frame = std::make_shared<Frame>(*view.frame);
  frame->timestamp = timestamp;
  return frame;
}

// Gives images to an initialiser until there is a map. Its views must be all as read, or none.
void ExpectViewsAsRead(const Sensor& sensor,
                       const std::function<std::shared_ptr<const Frame>(uint32_t)>& image,
                       bool as_read) {
  MonocularInitialiser initialiser(sensor, 1);
  std::vector<std::shared_ptr<const Frame>> given;
  for (uint32_t i = 0; i < 40; ++i) {
    given.push_back(image(i));
    if (const auto result = initialiser.Process(given.back()); result.map) {
      EXPECT_GE(result.map->views.size(), 3U);
      for (const InitialMap::View& view : result.map->views) {
        EXPECT_EQ(view.frame == given[view.frame->id.value], as_read);
      }
      return;
    }
  }
  ADD_FAILURE() << "there is no map";
}

TEST_F(MonocularStart, VelocitiesFromWrongStampsAreNotUsed) {
  const SyntheticWorld world({.points = 400, .depth_share = 0.0, .readout_time = 0.026});
  Sensor sensor = world.sensor();
  sensor.kind = SensorKind::kMonocular;
  for (const double frames_per_second : {30.0, 300.0, 2.0}) {
    const auto image = [&](uint32_t i) {
      return WithStamp(world.Observe(i), i / frames_per_second);
    };
    ExpectViewsAsRead(sensor, image, frames_per_second != 30.0);
  }
}

// The camera has a global shutter. It turns to and fro before it moves, so that wrong corrections
// of its images do not fit together.
TEST_F(MonocularStart, ACorrectionThatFitsWorseIsNotKept) {
  sensor_.readout_time = 0.1;
  sensor_.frames_per_second = 10.0;
  const auto image = [&](uint32_t i) {
    const Eigen::Vector3d turn(0.0, i / 3 == 1 ? 0.3 : 0.0, 0.0);
    const Rigid3 cam_from_world = Rigid3(ExpSo3(turn), Eigen::Vector3d::Zero()) *
                                  SyntheticWorld::CamFromWorld(i < 9 ? 0 : 40);
    return WithStamp(world_.Observe(FrameId(i), cam_from_world), i / 10.0);
  };
  ExpectViewsAsRead(sensor_, image, true);
}

TEST_F(MonocularStart, TellsThatTheImageHasTooFewFeatures) {
  const SyntheticWorld bare({.points = 60});
  MonocularInitialiser initialiser(sensor_, 1);
  EXPECT_EQ(initialiser.Process(bare.Observe(0).frame).failure,
            InitialisationFailure::kTooFewFeatures);
}

TEST_F(MonocularStart, TellsThatImagesHaveTooLittleInCommon) {
  MonocularInitialiser initialiser(sensor_, 1);
  for (uint32_t i = 0; i < 10; ++i) {
    const SyntheticWorld other({.points = 400, .depth_share = 0.0, .seed = i + 10});
    EXPECT_EQ(initialiser.Process(other.Observe(i).frame).failure,
              InitialisationFailure::kTooFewMatches);
  }
}

TEST_F(MonocularStart, TheSameFramesGiveTheSameBits) {
  MonocularInitialiser one(sensor_, 1);
  MonocularInitialiser two(sensor_, 1);
  const auto a = Walk(one, 0, 30);
  const auto b = Walk(two, 0, 30);
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->points.size(), b->points.size());
  for (size_t i = 0; i < a->points.size(); ++i) {
    EXPECT_EQ(a->points[i].position, b->points[i].position);
  }
  EXPECT_EQ(a->views.back().cam_from_world.ToMatrix(), b->views.back().cam_from_world.ToMatrix());
}

// The frame with only its first `count` features.
std::shared_ptr<Frame> Shortened(const Frame& frame, size_t count) {
  auto shortened = std::make_shared<Frame>(frame);
  shortened->features.keypoints.resize(count);
  shortened->features.descriptors.resize(count);
  shortened->features.depth.resize(count);
  return shortened;
}

TEST_F(MonocularStart, NeedsAHundredFeatures) {
  MonocularInitialiser initialiser(sensor_, 1);
  const std::shared_ptr<const Frame> observed = world_.Observe(0).frame;
  const Frame& frame = *observed;
  EXPECT_EQ(initialiser.Process(Shortened(frame, 99)).failure,
            InitialisationFailure::kTooFewFeatures);
  EXPECT_EQ(initialiser.Process(Shortened(frame, 100)).failure,
            InitialisationFailure::kTooFewMatches);
}

// Only the first features of the second image are those of the first image.
TEST_F(MonocularStart, NeedsEightyMatches) {
  const SyntheticWorld other({.points = 400, .depth_share = 0.0, .seed = 10});
  const auto failure_of = [&](size_t matches) {
    MonocularInitialiser initialiser(sensor_, 1);
    initialiser.Process(Shortened(*world_.Observe(0).frame, 150));
    const auto second = Shortened(*world_.Observe(0).frame, 150);
    second->id = FrameId(10);
    for (uint32_t i = static_cast<uint32_t>(matches); i < 150; ++i) {
      second->features.descriptors[i] = other.descriptor(i);
    }
    return initialiser.Process(second).failure;
  };
  EXPECT_EQ(failure_of(79), InitialisationFailure::kTooFewMatches);
  EXPECT_EQ(failure_of(80), InitialisationFailure::kTooLittleParallax);
}

// The camera goes around what it sees, so the rays have parallax although the keypoints hardly
// move.
TEST_F(MonocularStart, KeypointsMustMoveByAShareOfTheImagesWidth) {
  const double least = 0.015 * sensor_.camera.width;
  const auto give = [&](double step) {
    MonocularInitialiser initialiser(sensor_, 1);
    const SyntheticView first =
        world_.Observe(FrameId(0), SyntheticWorld::LookAt({0, 0, 0}, {0, 0, 3.2}));
    const SyntheticView last =
        world_.Observe(FrameId(10), SyntheticWorld::LookAt({step, 0, 0}, {0, 0, 3.2}));
    initialiser.Process(first.frame);
    return std::pair(initialiser.Process(last.frame), MedianShift(first, last));
  };
  double most_refused = 0.0;
  double least_taken = 1e9;
  for (double step = 0.02; step < 0.4; step += 0.005) {
    const auto [result, shift] = give(step);
    if (result.map) {
      least_taken = std::min(least_taken, shift);
    } else {
      EXPECT_EQ(result.failure, InitialisationFailure::kTooLittleParallax);
      most_refused = std::max(most_refused, shift);
    }
  }
  EXPECT_NEAR(most_refused, least, 0.4);
  EXPECT_NEAR(least_taken, least, 0.4);
}

// What is straight ahead hardly moves in the image, so it is enough if a quarter of the keypoints
// moves.
TEST_F(MonocularStart, ACameraThatMovesForwardNeedsFewerKeypointsThatMove) {
  const auto at = [](double z) {
    return Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.0, -z));
  };
  EXPECT_LT(MedianShift(world_.Observe(FrameId(0), at(0.0)), world_.Observe(FrameId(10), at(0.2))),
            0.015 * sensor_.camera.width);
  for (const double direction : {1.0, -1.0}) {
    MonocularInitialiser initialiser(sensor_, 1);
    EXPECT_FALSE(Give(initialiser, 0, at(0.0)).map);
    EXPECT_FALSE(Give(initialiser, 5, at(0.02 * direction)).map);
    const MonocularInitialiser::Result result = Give(initialiser, 10, at(0.2 * direction));
    ASSERT_TRUE(result.map);
    ExpectRight(*result.map);
  }
}

TEST_F(MonocularStart, EveryThirdFrameIsAReferenceAndThreeViewsAreBetween) {
  MonocularInitialiser initialiser(sensor_, 1);
  std::optional<InitialMap> map;
  uint32_t last = 0;
  for (; last < 90 && !map; ++last) {
    map = Give(initialiser, last, SyntheticWorld::CamFromWorld(0.25 * last)).map;
  }
  ASSERT_TRUE(map);
  ASSERT_EQ(map->views.size(), 5U);
  for (size_t i = 0; i + 1 < map->views.size(); ++i) {
    EXPECT_EQ(map->views[i].frame->id.value % 3, 0U);
  }
  EXPECT_EQ(map->views.back().frame->id.value, last - 1);
  // The last of the views between is the newest reference.
  EXPECT_LE(last - 1 - map->views[3].frame->id.value, 3U);
}

// Like AFrameInBetweenThatDoesNotFitPreventsTheMap, with this share of wrong features.
TEST_F(MonocularStart, AFrameInBetweenMustConfirmSixtyPercent) {
  const SyntheticView first = world_.Observe(0);
  const SyntheticView view = world_.Observe(FrameId(10), SyntheticWorld::CamFromWorld(1));
  const SyntheticView last = world_.Observe(20);
  std::vector<size_t> common;  // keypoints whose points all three frames show
  for (size_t i = 0; i < view.points.size(); ++i) {
    if (std::ranges::count(first.points, view.points[i]) > 0 &&
        std::ranges::count(last.points, view.points[i]) > 0) {
      common.push_back(i);
    }
  }
  const auto is_confirmed = [&](double wrong) {
    auto between = std::make_shared<Frame>(*view.frame);
    std::vector<Keypoint>& keypoints = between->features.keypoints;
    const size_t pairs = static_cast<size_t>(wrong * static_cast<double>(common.size())) / 2;
    for (size_t i = 0; i < pairs; ++i) {
      std::swap(keypoints[common[2 * i]].undistorted, keypoints[common[2 * i + 1]].undistorted);
    }
    MonocularInitialiser initialiser(sensor_, 1);
    initialiser.Process(first.frame);
    initialiser.Process(between);
    // Without the confirmation, the last two frames may make a map.
    const MonocularInitialiser::Result result = initialiser.Process(last.frame);
    return result.map && result.map->views.size() == 3;
  };
  EXPECT_TRUE(is_confirmed(0.36));
  EXPECT_FALSE(is_confirmed(0.44));
}

// An image between the others that shows something else, for example a passing car, tells nothing.
TEST_F(MonocularStart, AFrameInBetweenThatShowsSomethingElseDoesNotCount) {
  const SyntheticWorld other({.points = 400, .depth_share = 0.0, .seed = 10});
  MonocularInitialiser initialiser(sensor_, 1);
  EXPECT_FALSE(Give(initialiser, 0, SyntheticWorld::CamFromWorld(0)).map);
  EXPECT_FALSE(initialiser.Process(other.Observe(10).frame).map);
  const auto result = Give(initialiser, 20, SyntheticWorld::CamFromWorld(20));
  ASSERT_TRUE(result.map);
  EXPECT_EQ(result.map->views.size(), 2U);
  ExpectRight(*result.map);
}

// The failure is that of the reference with which an image came nearest to a map.
TEST_F(MonocularStart, TellsTheFailureOfTheBestReference) {
  const SyntheticWorld other({.points = 400, .depth_share = 0.0, .seed = 10});
  MonocularInitialiser initialiser(sensor_, 1);
  initialiser.Process(world_.Observe(0).frame);
  initialiser.Process(other.Observe(10).frame);
  EXPECT_EQ(Give(initialiser, 20, SyntheticWorld::CamFromWorld(0)).failure,
            InitialisationFailure::kTooLittleParallax);
}

TEST_F(MonocularStart, HasNoReferencesAfterAMap) {
  MonocularInitialiser initialiser(sensor_, 1);
  ASSERT_TRUE(Walk(initialiser, 0, 30));
  EXPECT_EQ(Give(initialiser, 60, SyntheticWorld::CamFromWorld(60)).failure,
            InitialisationFailure::kTooFewMatches);
}

// So slow that the last 12 references, 36 frames, have too little parallax.
TEST_F(MonocularStart, ReferencesReachFarBack) {
  MonocularInitialiser initialiser(sensor_, 1);
  std::optional<InitialMap> map;
  uint32_t last = 0;
  for (; last < 300 && !map; ++last) {
    map = Give(initialiser, last, SyntheticWorld::CamFromWorld(0.08 * last)).map;
  }
  ASSERT_TRUE(map);
  EXPECT_GT(last, 60U);
  ExpectRight(*map);
}

}  // namespace
}  // namespace hullslam
