// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/object_results.h"

#include <gtest/gtest.h>

#include <memory>
#include <numbers>

namespace hullslam {
namespace {

KeyframeId AddView(Map& map, uint32_t frame_id, const std::string& label) {
  auto frame = std::make_shared<Frame>();
  frame->id = FrameId(frame_id);
  frame->timestamp = 0.1 * frame_id;
  Detection detection;
  detection.label = label;
  detection.score = 0.5;
  detection.is_cut = true;
  detection.hull = {{0, 0}, {4, 0}, {4, 4}};
  detection.contour = std::vector<Eigen::Vector2d>{{0, 0}, {4, 0}, {4, 4}, {3, 2}};
  detection.lines = {{{Eigen::Vector2d::UnitY(), -4.0}, true}};
  frame->detections = {Detection(), detection};
  return map.AddKeyframe(frame, Rigid3(Eigen::Quaterniond::Identity(), {1.0 * frame_id, 0, 0}));
}

ObjectId AddShape(Map& map, ObjectState state) {
  const ObjectId id = map.AddObject();
  ObjectLandmark& object = map.MutableObject(id);
  object.state = state;
  object.has_shape = true;
  object.misfit_px = 3.0;
  object.ellipsoid.half_axes = {0.1, 0.2, 0.3};
  return id;
}

TEST(ObjectResults, ContainsWhatTheMapKnowsAboutAnObject) {
  Map map;
  const ObjectId id = AddShape(map, ObjectState::kMapped);
  map.AddObservation(id, AddView(map, 5, "cup"), 1);
  map.AddObservation(id, AddView(map, 7, "bowl"), 1);
  map.AddObservation(id, AddView(map, 8, "bowl"), 1);
  PinholeCamera camera;
  camera.fx = 500.0;
  const ObjectResults report = CollectObjectResults(map, camera);
  EXPECT_EQ(report.camera.fx, 500.0);
  EXPECT_EQ(report.candidates, 0U);
  ASSERT_EQ(report.objects.size(), 1U);
  const ObjectResult& object = report.objects[0];
  EXPECT_EQ(object.id, id);
  EXPECT_EQ(object.label, "bowl");
  EXPECT_EQ(object.state, ObjectState::kMapped);
  EXPECT_EQ(object.misfit_px, 3.0);
  EXPECT_EQ(object.ellipsoid.half_axes.z(), 0.3);
  ASSERT_EQ(object.observations.size(), 3U);
  const ObservationResult& observation = object.observations[1];
  EXPECT_EQ(observation.keyframe, KeyframeId(1));
  EXPECT_EQ(observation.timestamp, 0.1 * 7);
  EXPECT_EQ(observation.cam_from_world.translation.x(), 7.0);
  EXPECT_EQ(observation.label, "bowl");
  EXPECT_EQ(observation.score, 0.5);
  EXPECT_TRUE(observation.is_cut);
  EXPECT_EQ(observation.hull.size(), 3U);
  EXPECT_EQ(observation.contour.size(), 4U);
  ASSERT_EQ(observation.lines.size(), 1U);
  EXPECT_TRUE(observation.lines[0].is_one_sided);
}

TEST(ObjectResults, CountsCandidatesAndListsObjectsWithAShape) {
  Map map;
  const ObjectId shaped = AddShape(map, ObjectState::kCandidate);
  map.AddObservation(shaped, AddView(map, 0, "cup"), 1);
  map.AddObservation(map.AddObject(), AddView(map, 1, "cup"), 1);  // without a shape
  AddShape(map, ObjectState::kMapped);                             // without any observation
  const ObjectResults report = CollectObjectResults(map, PinholeCamera());
  EXPECT_EQ(report.candidates, 2U);
  ASSERT_EQ(report.objects.size(), 1U);
  EXPECT_EQ(report.objects[0].id, shaped);
}

TEST(ObjectResults, IsEmptyForAnEmptyMap) {
  const ObjectResults report = CollectObjectResults(Map(), PinholeCamera());
  EXPECT_TRUE(report.objects.empty());
  EXPECT_EQ(report.candidates, 0U);
}

// Cameras at a distance of 1 m whose rays to the centre are up to `degrees` apart.
ObjectResult SeenFrom(size_t observations, double degrees) {
  ObjectResult object;
  object.fit.siou = 0.8;
  for (size_t i = 0; i < observations; ++i) {
    const double angle =
        degrees * static_cast<double>(i) / (static_cast<double>(observations) - 1.0);
    const Eigen::Quaterniond turn(
        Eigen::AngleAxisd(angle * std::numbers::pi / 180.0, Eigen::Vector3d::UnitY()));
    object.observations.emplace_back().cam_from_world = Rigid3(turn, {0.0, 0.0, 1.0});
  }
  return object;
}

TEST(Quality, GrowsWithOverlapParallaxAndViews) {
  EXPECT_NEAR(ParallaxOf(SeenFrom(5, 12.0)), 12.0, 1e-6);
  EXPECT_NEAR(QualityOf(SeenFrom(10, 20.0)), 0.8, 1e-6);
  EXPECT_NEAR(QualityOf(SeenFrom(30, 60.0)), 0.8, 1e-6);
  EXPECT_NEAR(QualityOf(SeenFrom(10, 5.0)), 0.2, 1e-6);
  EXPECT_NEAR(QualityOf(SeenFrom(5, 20.0)), 0.4, 1e-6);
  ObjectResult unknown = SeenFrom(10, 20.0);
  unknown.fit.siou.reset();
  EXPECT_EQ(QualityOf(unknown), 0.0);
}

}  // namespace
}  // namespace hullslam
