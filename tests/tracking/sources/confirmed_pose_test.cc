// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/sources/confirmed_pose.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "camera/point_measurement.h"
#include "map/landmark_edits.h"
#include "support/random_geometry.h"
#include "support/ring_world.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

// What the sources below return, and how often they were asked.
struct Script {
  std::optional<PoseEstimate> first, second;
  int asked_second = 0;
};

Script& TheScript() {
  static Script script;
  return script;
}

std::optional<PoseEstimate> First(const Frame&, const Map&, const TrackingContext&,
                                  const LastFrame&) {
  return TheScript().first;
}

std::optional<PoseEstimate> Second(const Frame&, const Map&, const TrackingContext&,
                                   const LastFrame&) {
  ++TheScript().asked_second;
  return TheScript().second;
}

// The camera is at keyframe 0 of a map.
class ConfirmedPoseTest : public testing::Test {
 protected:
  ConfirmedPoseTest() { TheScript() = {}; }

  // A start whose pose is turned from the true one by so many pixels, and the landmarks that it
  // claims to have found.
  PoseEstimate Start(double pixels, int inliers) const {
    PoseEstimate start;
    start.cam_from_world =
        Rigid3(ExpSo3({0.0, pixels / world_.sensor().camera.fx, 0.0}), Eigen::Vector3d::Zero()) *
        keyframe_.cam_from_world;
    start.landmarks.resize(frame_->features.size());
    start.inliers = inliers;
    return start;
  }

  PoseSearch Search(std::span<PoseSource* const> sources) const {
    LastFrame last;
    last.reference = KeyframeId(0);
    return FindConfirmedPose(*frame_, made_.map, {world_.sensor(), options_, objects_, index_},
                             last, sources);
  }
  PoseSearch Search() const { return Search(std::array<PoseSource*, 2>{&First, &Second}); }

  const SyntheticWorld world_;
  SyntheticMap made_ = MakeSyntheticMap(world_, {0, 5});
  const Keyframe& keyframe_ = made_.map.keyframes().At(KeyframeId(0));
  std::shared_ptr<const Frame> frame_ =
      world_.Observe(FrameId(100), keyframe_.cam_from_world).frame;
  TrackingOptions options_;
  ObjectOptions objects_;
  const ObjectIndex index_{};
};

TEST_F(ConfirmedPoseTest, AStartWithManyLandmarksIsEnough) {
  TheScript().first = Start(0.0, 50);
  const PoseSearch search = Search();
  ASSERT_TRUE(search.found);
  EXPECT_EQ(search.found->source, 0u);
  EXPECT_EQ(TheScript().asked_second, 0);
}

// Wrong matches may agree by chance, and near their pose the local map has a few more of them.
TEST_F(ConfirmedPoseTest, OfTwoUncertainStartsTheOneWithMoreLandmarksCounts) {
  TheScript().first = Start(20.0, 49);
  TheScript().second = Start(0.0, 12);
  const PoseSearch both = Search();
  ASSERT_TRUE(both.found);
  EXPECT_EQ(TheScript().asked_second, 1);
  EXPECT_EQ(both.found->source, 1u);

  const PoseSearch first = Search(std::array<PoseSource*, 1>{&First});
  ASSERT_TRUE(first.found) << "the local map confirms the wrong start too";
  EXPECT_LT(first.found->tracking.estimate.inliers, both.found->tracking.estimate.inliers);

  std::swap(TheScript().first, TheScript().second);
  EXPECT_EQ(Search().found->source, 0u);
}

TEST_F(ConfirmedPoseTest, ACertainStartAfterAnUncertainOneMustBeBetter) {
  TheScript().first = Start(0.0, 12);
  TheScript().second = Start(20.0, 50);
  EXPECT_EQ(Search().found->source, 0u);
}

// Near a pose from objects some landmarks agree by chance. As many are needed as by words, unless
// the objects alone are enough.
TEST_F(ConfirmedPoseTest, AStartFromObjectsNeedsMoreLandmarks) {
  TheScript().first = Start(0.0, 50);
  const int found = Search().found->tracking.estimate.inliers;
  TheScript().first->keyframe_of_place = KeyframeId(0);
  options_.min_inliers = found * 3 / 5 - 1;
  EXPECT_TRUE(Search().found);
  options_.min_inliers = found * 4 / 5;
  EXPECT_FALSE(Search().found);
  TheScript().first->keyframe_of_place = KeyframeId();
  EXPECT_TRUE(Search().found);
}

// If the camera has drifted, the pose of the old place does not fit to the last frame. A loop must
// correct the drift; a jump of the camera to the old place would hide it.
TEST(ConfirmedPose, AFrameThatIsTrackedIsNotRelocalised) {
  const RingWorld& world = SharedRing();
  const RingMap made = MakeRingMap(world, {.keyframes = 16, .drift = Rigid3()});
  const Keyframe& keyframe = made.map.keyframes().At(KeyframeId(3));
  const auto frame = world.Observe(FrameId(1000), keyframe.cam_from_world).frame;
  PoseEstimate start;
  start.cam_from_world =
      Rigid3(ExpSo3({0.0, 0.04, 0.0}), Eigen::Vector3d::Zero()) * keyframe.cam_from_world;
  start.landmarks.resize(frame->features.size());
  start.inliers = 12;
  TheScript() = {};
  TheScript().first = start;
  LastFrame last;
  last.reference = KeyframeId(3);
  const TrackingOptions options;
  const ObjectOptions objects;
  const ObjectIndex index;
  const auto search = [&](std::span<PoseSource* const> sources) {
    return FindConfirmedPose(*frame, made.map, {world.sensor(), options, objects, index}, last,
                             sources);
  };
  const PoseSearch tracked = search(std::array<PoseSource*, 2>{&First, &PoseByRelocalisation});
  const PoseSearch relocalised = search(std::array<PoseSource*, 1>{&PoseByRelocalisation});
  ASSERT_TRUE(tracked.found);
  ASSERT_TRUE(relocalised.found);
  EXPECT_EQ(tracked.found->source, 0u);
  EXPECT_LT(tracked.found->tracking.estimate.inliers, relocalised.found->tracking.estimate.inliers);
}

// A keyframe at the origin that sees these points, and the search in its own frame from its pose.
PoseSearch SearchAmong(const std::vector<Eigen::Vector3d>& points) {
  const Sensor sensor = SyntheticSensor();
  const auto frame = std::make_shared<Frame>();
  FrameFeatures& features = frame->features;
  std::mt19937_64 random(1);
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d measured = ProjectRgbd(sensor.camera, point);
    features.keypoints.emplace_back().undistorted = measured.head<2>().cast<float>();
    features.descriptors.push_back({random(), random(), random(), random()});
    features.depth.push_back(static_cast<float>(point.z()));
  }
  features.grid = FeatureGrid(features.keypoints, {0.0f, 0.0f}, {640.0f, 480.0f});
  Map map;
  const KeyframeId keyframe = map.AddKeyframe(frame, Rigid3());
  for (uint32_t i = 0; i < points.size(); ++i) {
    const LandmarkId id = map.AddLandmark(points[i], keyframe);
    map.AddObservation(id, keyframe, i);
    UpdateDescriptor(map, id);
    UpdateViewingGeometry(map, id, sensor.levels);
  }
  TheScript() = {};
  TheScript().first.emplace().landmarks.resize(points.size());
  const TrackingOptions options;
  const ObjectOptions objects;
  const ObjectIndex index;
  LastFrame last;
  last.reference = keyframe;
  return FindConfirmedPose(*frame, map, {sensor, options, objects, index}, last,
                           std::array<PoseSource*, 1>{&First});
}

// Landmarks on a narrow strip, such as a skirting board, agree with poses that turn about it. As
// many in the whole image determine the pose.
TEST(ConfirmedPose, LandmarksOnANarrowStripDoNotConfirmIt) {
  RandomGeometry random(1);
  std::vector<Eigen::Vector3d> spread;
  std::vector<Eigen::Vector3d> strip;
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d place = random.Vector(1.0);
    spread.push_back(Eigen::Vector3d(0.0, 0.0, 3.0) +
                     place.cwiseProduct(Eigen::Vector3d(1.2, 0.9, 0.5)));
    strip.push_back(Eigen::Vector3d(0.8, 0.9, 3.0) +
                    place.cwiseProduct(Eigen::Vector3d(0.4, 0.03, 0.05)));
  }
  const PoseSearch found = SearchAmong(spread);
  ASSERT_TRUE(found.found);
  EXPECT_EQ(found.found->tracking.estimate.inliers, 40);
  const PoseSearch refused = SearchAmong(strip);
  EXPECT_FALSE(refused.found);
  EXPECT_EQ(refused.most_unconfirmed, 40);
}

// The map of a camera without depth may have bent. Images that are far apart then say so, while
// the landmarks fit.
TEST_F(ConfirmedPoseTest, WithoutDepthPairsOfImagesConfirmWideMatches) {
  const SyntheticView view = world_.Observe(30);
  const auto found = [&](SensorKind kind, bool is_wide, double turned) {
    SyntheticMap made = MakeSyntheticMap(world_, {0, 20, 40, 60});
    for (uint32_t i = 0; i < 4; ++i) {
      made.map.SetPose(KeyframeId(i), Rigid3(ExpSo3({0.0, turned, 0.0}), Eigen::Vector3d::Zero()) *
                                          made.map.keyframes().At(KeyframeId(i)).cam_from_world);
    }
    Sensor sensor = world_.sensor();
    sensor.kind = kind;
    TheScript().first = Start(0.0, 50);
    TheScript().first->cam_from_world = SyntheticWorld::CamFromWorld(30);
    TheScript().first->landmarks.resize(view.frame->features.size());
    LastFrame last;
    last.reference = KeyframeId(1);
    const TrackingContext context{sensor, options_, objects_, index_, 0, is_wide};
    return FindConfirmedPose(*view.frame, made.map, context, last,
                             std::array<PoseSource*, 1>{&First})
        .found.has_value();
  };
  EXPECT_TRUE(found(SensorKind::kMonocular, true, 0.0));
  EXPECT_FALSE(found(SensorKind::kMonocular, true, 0.05));
  EXPECT_TRUE(found(SensorKind::kMonocular, false, 0.05));
  EXPECT_TRUE(found(SensorKind::kRgbd, true, 0.05));
}

TEST_F(ConfirmedPoseTest, TellsHowManyLandmarksAnUnconfirmedPoseHad) {
  TheScript().first = Start(60.0, 100);
  const PoseSearch search = Search();
  EXPECT_FALSE(search.found);
  EXPECT_LT(search.most_unconfirmed, options_.min_inliers);
}

}  // namespace
}  // namespace hullslam
