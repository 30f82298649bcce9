// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/keyframe_insertion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "hullslam/util/check.h"
#include "map/islands.h"
#include "map_files/invariants.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

// One view at the origin with a point for each keypoint with depth.
InitialMap InitialMapOf(const SyntheticView& view, const PinholeCamera& camera) {
  InitialMap initial;
  initial.views.push_back({view.frame, Rigid3()});
  for (const uint32_t i : KeypointsByDepth(view.frame->features)) {
    const Eigen::Vector2d pixel = view.frame->features.keypoints[i].undistorted.cast<double>();
    const double depth = static_cast<double>(view.frame->features.depth[i]);
    initial.points.push_back({camera.Unproject(pixel, depth), {{0, i}}});
  }
  return initial;
}

// A request for the path's frame relative to keyframe `reference`, with all landmarks that the map
// has of its keypoints.
KeyframeRequest Request(const SyntheticMap& made, const SyntheticView& view, uint32_t index,
                        KeyframeId reference) {
  KeyframeRequest request;
  request.frame = view.frame;
  request.pose = made.map.RelativeTo(reference, SyntheticWorld::CamFromWorld(index));
  for (const uint32_t point : view.points) {
    request.landmarks.push_back(made.landmarks[point]);
  }
  return request;
}

size_t CountLandmarks(const Keyframe& keyframe) {
  return static_cast<size_t>(std::count_if(keyframe.landmarks.begin(), keyframe.landmarks.end(),
                                           [](LandmarkId id) { return id.IsValid(); }));
}

TEST(InitialMapInsertion, PointsOfOneViewBecomeItsLandmarks) {
  const SyntheticWorld world({.depth_share = 0.7});
  const SyntheticView view = world.Observe(0);
  Map map;
  std::vector<LandmarkId> created;
  const InitialMap initial = InitialMapOf(view, world.sensor().camera);
  const std::vector<KeyframeId> ids = InsertInitialMap(map, initial, world.sensor(), created);
  ASSERT_EQ(ids.size(), 1u);
  const KeyframeId id = ids[0];
  EXPECT_EQ(id, KeyframeId(0));
  EXPECT_EQ(FindViolations(map), std::vector<std::string>());
  const Keyframe& keyframe = map.keyframes().At(id);
  EXPECT_FALSE(keyframe.parent.IsValid());
  EXPECT_EQ(keyframe.cam_from_world.translation, Eigen::Vector3d::Zero());
  size_t with_depth = 0;
  for (size_t i = 0; i < view.points.size(); ++i) {
    const bool has_depth = view.frame->features.depth[i] > 0.0f;
    with_depth += has_depth ? 1 : 0;
    ASSERT_EQ(keyframe.landmarks[i].IsValid(), has_depth);
    if (has_depth) {
      const Landmark& landmark = map.landmarks().At(keyframe.landmarks[i]);
      EXPECT_LT((landmark.position - world.points()[view.points[i]]).norm(), 1e-5);
      EXPECT_EQ(landmark.descriptor, world.descriptor(view.points[i]));
      EXPECT_EQ(landmark.created_by, id);
    }
  }
  EXPECT_GT(with_depth, 100u);
  EXPECT_EQ(created.size(), with_depth);
  EXPECT_EQ(map.landmarks().size(), with_depth);
}

// Two views that share points, as at the beginning of a monocular map.
TEST(InitialMapInsertion, PointsOfTwoViewsAreObservedByBoth) {
  const SyntheticWorld world({.depth_share = 0.0});
  const SyntheticView a = world.Observe(0);
  const SyntheticView b = world.Observe(10);
  InitialMap initial;
  initial.views = {{a.frame, SyntheticWorld::CamFromWorld(0)},
                   {b.frame, SyntheticWorld::CamFromWorld(10)}};
  for (uint32_t i = 0; i < a.points.size(); ++i) {
    const auto same = std::find(b.points.begin(), b.points.end(), a.points[i]);
    if (same != b.points.end()) {
      initial.points.push_back({world.points()[a.points[i]],
                                {{0, i}, {1, static_cast<uint32_t>(same - b.points.begin())}}});
    }
  }
  Map map;
  std::vector<LandmarkId> created;
  const std::vector<KeyframeId> ids = InsertInitialMap(map, initial, world.sensor(), created);
  EXPECT_EQ(FindViolations(map), std::vector<std::string>());
  ASSERT_EQ(ids.size(), 2u);
  EXPECT_GT(created.size(), 100u);
  EXPECT_EQ(created.size(), initial.points.size());
  EXPECT_FALSE(map.keyframes().At(ids[0]).parent.IsValid());
  EXPECT_EQ(map.keyframes().At(ids[1]).parent, ids[0]);
  EXPECT_EQ(CountLandmarks(map.keyframes().At(ids[1])), created.size());
  for (size_t i = 0; i < created.size(); ++i) {
    const Landmark& landmark = map.landmarks().At(created[i]);
    EXPECT_EQ(landmark.position, initial.points[i].position);
    EXPECT_EQ(landmark.observations.size(), 2u);
    EXPECT_GT(landmark.max_distance, 0.0);
  }
}

TEST(InitialMapInsertion, ViewsWithoutSharedPointsAreInOneTree) {
  const SyntheticWorld world;
  InitialMap initial;
  initial.views = {{world.Observe(0).frame, Rigid3()}, {world.Observe(1).frame, Rigid3()}};
  Map map;
  std::vector<LandmarkId> created;
  const std::vector<KeyframeId> ids = InsertInitialMap(map, initial, world.sensor(), created);
  EXPECT_EQ(map.keyframes().At(ids[1]).parent, ids[0]);
  EXPECT_EQ(FindViolations(map), std::vector<std::string>());
}

TEST(InitialMapInsertion, AnotherOneBecomesAnIslandWhichGrowsByItsOwnKeyframes) {
  const SyntheticWorld world;
  Map map;
  std::vector<LandmarkId> created;
  for (const uint32_t frame : {0u, 30u}) {
    InsertInitialMap(map, InitialMapOf(world.Observe(frame), world.sensor().camera), world.sensor(),
                     created);
  }
  EXPECT_EQ(FindViolations(map), std::vector<std::string>());
  EXPECT_EQ(Islands(map), (std::vector<IslandId>{IslandId(0), IslandId(1)}));
  EXPECT_FALSE(map.keyframes().At(KeyframeId(1)).parent.IsValid());
  for (const uint32_t reference : {0u, 1u}) {
    KeyframeRequest request;
    request.frame = world.Observe(40 + reference).frame;
    request.pose = map.RelativeTo(KeyframeId(reference), Rigid3());
    const KeyframeId id = InsertKeyframe(map, request, world.sensor(), created);
    EXPECT_EQ(IslandOf(map, id), IslandId(reference));
    EXPECT_EQ(map.keyframes().At(id).parent, KeyframeId(reference));
  }
}

// By the rule of ORB-SLAM2, a keyframe after the initial map makes landmarks of all close keypoints
// and of the nearest hundred.
void ExpectNearestAreTaken(double close_depth, bool more_than_hundred_are_close) {
  const SyntheticWorld world;
  Sensor sensor = world.sensor();
  sensor.close_depth = close_depth;
  SyntheticMap made = MakeSyntheticMap(world, {0, 5});
  const SyntheticView view = world.Observe(10);
  KeyframeRequest request = Request(made, view, 10, KeyframeId(1));
  request.landmarks.assign(view.points.size(), LandmarkId());
  std::vector<LandmarkId> created;
  const KeyframeId id = InsertKeyframe(made.map, request, sensor, created, MappingRule::kOrbSlam2);
  EXPECT_EQ(FindViolations(made.map), std::vector<std::string>());
  float farthest_taken = 0.0f;
  float nearest_left = 1e9f;
  size_t close = 0;
  const Keyframe& keyframe = made.map.keyframes().At(id);
  for (size_t i = 0; i < view.points.size(); ++i) {
    const float depth = view.frame->features.depth[i];
    close += depth > 0.0f && static_cast<double>(depth) <= close_depth ? 1 : 0;
    if (keyframe.landmarks[i].IsValid()) {
      farthest_taken = std::max(farthest_taken, depth);
    } else if (depth > 0.0f) {
      nearest_left = std::min(nearest_left, depth);
    }
  }
  EXPECT_EQ(close > 100, more_than_hundred_are_close);
  EXPECT_EQ(created.size(), std::max<size_t>(close, 100));
  EXPECT_EQ(CountLandmarks(keyframe), created.size());
  EXPECT_LT(farthest_taken, nearest_left);
}

TEST(KeyframeInsertion, ByTheRuleOfOrbSlam2AllCloseKeypointsBecomeLandmarks) {
  ExpectNearestAreTaken(4.5, true);
}

TEST(KeyframeInsertion, ByTheRuleOfOrbSlam2TheNearestHundredDoIfFewAreClose) {
  ExpectNearestAreTaken(2.2, false);
}

// A hundred are enough for the image, but each part of it gets its share, also if it is far away.
TEST(KeyframeInsertion, EachPartOfTheImageGetsItsShareOfLandmarks) {
  const SyntheticWorld world;
  SyntheticMap made = MakeSyntheticMap(world, {0, 5});
  const SyntheticView view = world.Observe(10);
  Sensor sensor = world.sensor();
  KeyframeRequest request = Request(made, view, 10, KeyframeId(1));
  request.landmarks.assign(view.points.size(), LandmarkId());
  sensor.close_depth = 0.0;  // all are far
  std::vector<LandmarkId> created;
  const KeyframeId id = InsertKeyframe(made.map, request, sensor, created);
  EXPECT_EQ(FindViolations(made.map), std::vector<std::string>());
  EXPECT_GE(created.size(), 100u);
  EXPECT_LT(created.size(), view.points.size() / 2);
  const Keyframe& keyframe = made.map.keyframes().At(id);
  std::array<size_t, 12> keypoints{};  // with depth, in each of 4 x 3 parts
  std::array<size_t, 12> landmarks{};
  for (size_t i = 0; i < view.points.size(); ++i) {
    const PinholeCamera::Bounds& area = sensor.bounds;
    const Eigen::Vector2f& pixel = view.frame->features.keypoints[i].undistorted;
    const auto column =
        static_cast<size_t>(4.0 * (pixel.x() - area.min_x) / (area.max_x - area.min_x));
    const auto row =
        static_cast<size_t>(3.0 * (pixel.y() - area.min_y) / (area.max_y - area.min_y));
    keypoints.at(4 * row + column) += view.frame->features.depth[i] > 0.0f ? 1 : 0;
    landmarks.at(4 * row + column) += keyframe.landmarks[i].IsValid() ? 1 : 0;
  }
  for (size_t part = 0; part < keypoints.size(); ++part) {
    EXPECT_GE(landmarks[part], std::min<size_t>(keypoints[part], 9)) << part;
  }
}

// A part that the map knows well needs no more landmarks; others may.
TEST(KeyframeInsertion, KnownLandmarksCountForTheShareOfTheirPart) {
  const SyntheticWorld world({.points = 1500});
  SyntheticMap made = MakeSyntheticMap(world, {9, 10});
  const SyntheticView view = world.Observe(11);
  Sensor sensor = world.sensor();
  sensor.close_depth = 0.0;  // all are far
  KeyframeRequest request = Request(made, view, 11, KeyframeId(1));
  for (size_t i = 0; i < request.landmarks.size(); i += 2) {
    request.landmarks[i] = LandmarkId();
  }
  Map copy = made.map.Snapshot();
  std::vector<LandmarkId> beside_known;
  InsertKeyframe(copy, request, sensor, beside_known);
  request.landmarks.assign(view.points.size(), LandmarkId());
  std::vector<LandmarkId> all;
  InsertKeyframe(made.map, request, sensor, all);
  ASSERT_GT(all.size(), 100u);
  EXPECT_LT(beside_known.size(), 0.65 * all.size()) << "every second one is known";
  EXPECT_GT(beside_known.size(), 0.35 * all.size());
}

TEST(KeyframeInsertion, KnownLandmarksAreObservedAndNotMadeAgain) {
  const SyntheticWorld world;
  SyntheticMap made = MakeSyntheticMap(world, {0, 5});
  const SyntheticView view = world.Observe(10);
  std::vector<LandmarkId> created;
  const KeyframeRequest request = Request(made, view, 10, KeyframeId(0));
  const KeyframeId id = InsertKeyframe(made.map, request, world.sensor(), created);
  EXPECT_EQ(FindViolations(made.map), std::vector<std::string>());
  const Keyframe& keyframe = made.map.keyframes().At(id);
  for (size_t i = 0; i < request.landmarks.size(); ++i) {
    if (request.landmarks[i].IsValid()) {
      EXPECT_EQ(keyframe.landmarks[i], request.landmarks[i]);
    }
  }
  for (const LandmarkId landmark : created) {
    EXPECT_EQ(made.map.landmarks().At(landmark).observations.size(), 1u);
  }
  const Rigid3 truth = SyntheticWorld::CamFromWorld(10);
  EXPECT_LT((keyframe.cam_from_world.translation - truth.translation).norm(), 1e-12);
  EXPECT_EQ(keyframe.covisible.size(), 2u);
  EXPECT_EQ(keyframe.parent, KeyframeId(1)) << "it shares more with the nearer one";
}

TEST(KeyframeInsertion, ThePoseFollowsAReferenceThatWasMovedOrCulled) {
  const SyntheticWorld world;
  SyntheticMap made = MakeSyntheticMap(world, {0, 5, 8});
  const SyntheticView view = world.Observe(10);
  const KeyframeRequest request = Request(made, view, 10, KeyframeId(1));
  made.map.CullKeyframe(KeyframeId(1));
  const Rigid3 old_from_new(ExpSo3({0.1, 0.2, 0.3}), {1.0, 2.0, 3.0});
  for (const KeyframeId id : {KeyframeId(0), KeyframeId(2)}) {
    made.map.SetPose(id, made.map.CamFromWorld(id) * old_from_new);
  }
  std::vector<LandmarkId> created;
  const KeyframeId id = InsertKeyframe(made.map, request, world.sensor(), created);
  EXPECT_EQ(FindViolations(made.map), std::vector<std::string>());
  const Rigid3 expected = SyntheticWorld::CamFromWorld(10) * old_from_new;
  const Rigid3& actual = made.map.keyframes().At(id).cam_from_world;
  EXPECT_LT((actual.translation - expected.translation).norm(), 1e-12);
  EXPECT_LT(AngularDistance(actual.rotation, expected.rotation), 1e-12);
}

TEST(KeyframeInsertion, ResolvesErasedAndReplacedLandmarks) {
  const SyntheticWorld world;
  SyntheticMap made = MakeSyntheticMap(world, {0, 5});
  const SyntheticView view = world.Observe(10);
  KeyframeRequest request = Request(made, view, 10, KeyframeId(1));
  std::vector<uint32_t> known;
  for (uint32_t i = 0; i < request.landmarks.size() && known.size() < 3; ++i) {
    if (request.landmarks[i].IsValid() && view.frame->features.depth[i] < 4.0f) {
      known.push_back(i);
    }
  }
  const LandmarkId erased = request.landmarks[known[0]];
  const LandmarkId replaced = request.landmarks[known[1]];
  const LandmarkId kept = request.landmarks[known[2]];
  request.sightings = {{erased, 5, 5}, {replaced, 7, 4}, {kept, 10, 9}, {LandmarkId(), 1, 1}};
  made.map.EraseLandmark(erased);
  made.map.ReplaceLandmark(replaced, kept);
  const int visible = made.map.landmarks().At(kept).visible;
  const int found = made.map.landmarks().At(kept).found;
  std::vector<LandmarkId> created;
  const KeyframeId id = InsertKeyframe(made.map, request, world.sensor(), created);
  EXPECT_EQ(FindViolations(made.map), std::vector<std::string>());
  const std::vector<LandmarkId>& slots = made.map.keyframes().At(id).landmarks;
  EXPECT_NE(slots[known[0]], erased);
  EXPECT_EQ(slots[known[1]], kept) << "the first keypoint that resolves to it";
  EXPECT_NE(slots[known[2]], kept) << "a keyframe observes a landmark once";
  EXPECT_EQ(made.map.landmarks().At(kept).visible, visible + 17);
  EXPECT_EQ(made.map.landmarks().At(kept).found, found + 13);
}

TEST(KeyframeInsertion, WithoutASharedLandmarkItIsAChildOfItsReference) {
  const SyntheticWorld world;
  SyntheticMap made = MakeSyntheticMap(world, {0, 5, 8});
  const SyntheticView view = world.Observe(10);
  const KeyframeRequest request = Request(made, view, 10, KeyframeId(1));
  for (const LandmarkId landmark : request.landmarks) {
    if (landmark.IsValid()) {
      made.map.EraseLandmark(landmark);
    }
  }
  const KeyframeId expected = made.map.keyframes().At(KeyframeId(1)).parent;
  made.map.CullKeyframe(KeyframeId(1));
  std::vector<LandmarkId> created;
  const KeyframeId id = InsertKeyframe(made.map, request, world.sensor(), created);
  EXPECT_EQ(FindViolations(made.map), std::vector<std::string>());
  EXPECT_TRUE(made.map.keyframes().At(id).covisible.empty());
  EXPECT_EQ(made.map.keyframes().At(id).parent, expected)
      << "one root: a second one could become the child of its own descendant";
}

}  // namespace
}  // namespace hullslam
