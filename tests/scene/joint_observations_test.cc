// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/joint_observations.h"

#include <gtest/gtest.h>

#include <utility>

#include "scene/made_scene.h"

namespace hullslam {
namespace {

// A keyframe at the origin that looks along z and sees the objects whose entry in `seen` is true.
void AddFrontView(Map& map, const Sensor& sensor, const std::vector<MadeObject>& objects,
                  const std::vector<ObjectId>& ids, const std::vector<bool>& seen) {
  auto frame = std::make_shared<Frame>();
  frame->id = FrameId(static_cast<uint32_t>(map.keyframes().size()));
  std::vector<ObjectId> shown;
  for (size_t i = 0; i < ids.size(); ++i) {
    if (seen[i]) {
      frame->detections.push_back(Detect(objects[i], sensor, Rigid3()));
      shown.push_back(ids[i]);
    }
  }
  const KeyframeId keyframe = map.AddKeyframe(frame, Rigid3());
  for (uint32_t k = 0; k < shown.size(); ++k) {
    map.AddObservation(shown[k], keyframe, k);
  }
}

TEST(ObservationStatistics, TellWhatIsBeforeAndWhatIsHidden) {
  const Sensor sensor = MakeObjectSensor();
  const auto facing = [](double depth) {
    return Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.0, depth));
  };
  const std::vector<MadeObject> objects = {{"cup", {facing(1.0), {0.1, 0.1, 0.1}}},
                                           {"tv", {facing(2.0), {0.3, 0.3, 0.1}}}};
  Map map;
  std::vector<ObjectId> ids;
  for (const MadeObject& object : objects) {
    ids.push_back(map.AddObject());
    map.MutableObject(ids.back()).state = ObjectState::kMapped;
    map.MutableObject(ids.back()).ellipsoid = object.ellipsoid;
  }
  AddFrontView(map, sensor, objects, ids, {true, true});
  AddFrontView(map, sensor, objects, ids, {true, false});
  const ObservationStatistics statistics = CollectObservationStatistics(map, sensor.camera);
  const JointObservations& joint = statistics.Joint(ids[0], ids[1]);
  EXPECT_EQ(joint.observations, 1U);
  EXPECT_EQ(joint.in_front, 1U);
  EXPECT_EQ(joint.mask_inside, 1U);
  EXPECT_EQ(statistics.Joint(ids[1], ids[0]).in_front, 0U);
  EXPECT_EQ(statistics.Joint(ids[1], ids[0]).mask_inside, 0U);
  const HiddenCounts& hidden = statistics.hidden.at({ids[1], ids[0]});
  EXPECT_EQ(hidden.observations, 2U);
  EXPECT_EQ(hidden.hidden, 2U);
  EXPECT_NEAR(hidden.most, 0.44, 0.03);  // (0.1 / 0.3 * 2)^2
  EXPECT_EQ(statistics.hidden.at({ids[0], ids[1]}).hidden, 0U);
  EXPECT_EQ(statistics.Joint(ids[0], ObjectId(77)).observations, 0U);
}

// The boxes of the cup and of the screen are 104 and 156 px wide. Half of the cup's box must be
// before the screen.
TEST(ObservationStatistics, AnObjectAtTheSideIsNotInFront) {
  const Sensor sensor = MakeObjectSensor();
  const auto views_in_front = [&](double aside) {
    const auto at = [](double x, double depth) {
      return Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, 0.0, depth));
    };
    const std::vector<MadeObject> objects = {{"cup", {at(aside, 1.0), {0.1, 0.1, 0.1}}},
                                             {"tv", {at(0.0, 2.0), {0.3, 0.3, 0.1}}}};
    Map map;
    std::vector<ObjectId> ids;
    for (const MadeObject& object : objects) {
      ids.push_back(map.AddObject());
      map.MutableObject(ids.back()).state = ObjectState::kMapped;
      map.MutableObject(ids.back()).ellipsoid = object.ellipsoid;
    }
    AddFrontView(map, sensor, objects, ids, {true, true});
    return CollectObservationStatistics(map, sensor.camera).Joint(ids[0], ids[1]).in_front;
  };
  EXPECT_EQ(views_in_front(0.13), 1U);  // 62 px are common
  EXPECT_EQ(views_in_front(-0.13), 1U);
  EXPECT_EQ(views_in_front(0.19), 0U);  // 31 px
  EXPECT_EQ(views_in_front(-0.19), 0U);
}

// What a keyframe at the origin tells about two objects.
std::pair<JointObservations, HiddenCounts> StatisticsOf(const Ellipsoid& a, const Ellipsoid& b) {
  const Sensor sensor = MakeObjectSensor();
  const std::vector<MadeObject> objects = {{"cup", a}, {"tv", b}};
  Map map;
  std::vector<ObjectId> ids;
  for (const MadeObject& object : objects) {
    ids.push_back(map.AddObject());
    map.MutableObject(ids.back()).state = ObjectState::kMapped;
    map.MutableObject(ids.back()).ellipsoid = object.ellipsoid;
  }
  AddFrontView(map, sensor, objects, ids, {true, true});
  const ObservationStatistics statistics = CollectObservationStatistics(map, sensor.camera);
  return {statistics.Joint(ids[0], ids[1]), statistics.hidden.at({ids[1], ids[0]})};
}

Ellipsoid Ball(double x, double depth, double radius) {
  return {Rigid3(Eigen::Quaterniond::Identity(), {x, 0.0, depth}),
          Eigen::Vector3d::Constant(radius)};
}

// The centre of each is outside of the middle half of the other.
TEST(ObservationStatistics, ObjectsAtTheSameDepthAreNotInFront) {
  const auto in_front = [](double radius_a, double depth_b, double radius_b) {
    return StatisticsOf(Ball(0.0, 2.0, radius_a), Ball(0.0, depth_b, radius_b)).first.in_front;
  };
  EXPECT_EQ(in_front(0.1, 2.06, 0.1), 1U);
  EXPECT_EQ(in_front(0.1, 2.04, 0.1), 0U);
  EXPECT_EQ(in_front(0.3, 2.16, 0.1), 1U);
  EXPECT_EQ(in_front(0.3, 2.14, 0.1), 0U);
  EXPECT_EQ(in_front(0.1, 2.16, 0.3), 1U);
  EXPECT_EQ(in_front(0.1, 2.14, 0.3), 0U);
}

// A ball of radius r at 1 m covers about (2 r / 0.3)^2 of one of radius 0.3 m at 2 m.
TEST(ObservationStatistics, LessThanAQuarterIsNotHidden) {
  const auto hidden = [](double radius) {
    return StatisticsOf(Ball(0.0, 1.0, radius), Ball(0.0, 2.0, 0.3)).second;
  };
  EXPECT_EQ(hidden(0.08).hidden, 1U);
  EXPECT_EQ(hidden(0.07).hidden, 0U);
  EXPECT_NEAR(hidden(0.07).most, 0.22, 0.02);
  EXPECT_EQ(hidden(0.5).most, 1.0) << "a share is not above 1";
}

TEST(ObservationStatistics, AMaskIsInsideIfFourFifthsOfItsHullAre) {
  const auto inside = [](double aside) {
    return StatisticsOf(Ball(aside, 1.0, 0.1), Ball(0.0, 2.0, 0.6)).first.mask_inside;
  };
  EXPECT_EQ(inside(0.2), 1U);
  EXPECT_EQ(inside(0.23), 1U);  // 87 %
  EXPECT_EQ(inside(0.27), 0U);  // 70 %
}

}  // namespace
}  // namespace hullslam
