// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/object_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "geometry/polygon.h"
#include "objects/constraint/point_statistics.h"
#include "objects/made_objects.h"
#include "objects/resolved_observation.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

class ObjectIndexTest : public ::testing::Test {
 protected:
  // An object that one keyframe at `cam_from_world` sees.
  ObjectId Add(const MadeObject& made, const Rigid3& cam_from_world, bool has_shape) {
    const KeyframeId keyframe = AddObserver(map_, sensor_, cam_from_world, {made});
    const ObjectId id = map_.AddObject();
    map_.AddObservation(id, keyframe, 0);
    map_.MutableObject(id).has_shape = has_shape;
    map_.MutableObject(id).ellipsoid = made.ellipsoid;
    return id;
  }
  std::vector<ObjectId> Visible(const Rigid3& cam_from_world) const {
    return ObjectIndex(map_, sensor_.camera).FindVisible(sensor_, cam_from_world, IslandId(0));
  }
  bool IsInImage(const std::vector<Eigen::Vector2d>& polygon) const {
    const Eigen::AlignedBox2d image(Eigen::Vector2d(sensor_.bounds.min_x, sensor_.bounds.min_y),
                                    Eigen::Vector2d(sensor_.bounds.max_x, sensor_.bounds.max_y));
    return !ClipToBox(polygon, image).empty();
  }

  Sensor sensor_ = MakeObjectSensor();
  Map map_;
  MadeObject cup_ = MakeObject("cup", Eigen::Vector3d::Zero(), {0.05, 0.05, 0.08});
};

TEST_F(ObjectIndexTest, FindsOnlyObjectsInTheImage) {
  const Rigid3 here = CameraOnCircle(0.0, 1.5, 0.5);
  const Rigid3 turned_away(Eigen::Quaterniond(0.0, 0.0, 1.0, 0.0), Eigen::Vector3d::Zero());
  for (const bool has_shape : {true, false}) {
    map_ = Map();
    const ObjectId id = Add(cup_, here, has_shape);
    EXPECT_EQ(Visible(here), std::vector<ObjectId>{id});
    EXPECT_EQ(Visible(CameraOnCircle(2.0, 1.0, 0.2)), std::vector<ObjectId>{id});
    EXPECT_TRUE(Visible(turned_away * here).empty());
  }
}

TEST_F(ObjectIndexTest, AnObjectWithoutKnownLocationMayBeVisibleAnywhere) {
  MadeObject flat = cup_;
  const Rigid3 here = CameraOnCircle(0.0, 1.5, 0.5);
  auto frame = std::make_shared<Frame>();
  frame->detections.push_back(Detect(flat, sensor_, here));
  frame->detections.back().points.clear();
  const KeyframeId keyframe = map_.AddKeyframe(std::move(frame), here);
  const ObjectId id = map_.AddObject();
  EXPECT_TRUE(Visible(here).empty()) << "no keyframe observes it";
  map_.AddObservation(id, keyframe, 0);
  const Rigid3 turned_away(Eigen::Quaterniond(0.0, 0.0, 1.0, 0.0), Eigen::Vector3d::Zero());
  EXPECT_EQ(Visible(turned_away * here), std::vector<ObjectId>{id});
}

// For many objects and cameras, every object whose ellipse is in the image is found.
TEST_F(ObjectIndexTest, FindsEveryObjectInTheImage) {
  RandomGeometry random(4);
  for (int i = 0; i < 60; ++i) {
    const MadeObject made = MakeObject("cup", random.Vector(1.5), {0.05, 0.1, 0.3});
    Add(made, CameraOnCircle(0.1 * i, 4.0, 0.5), true);
  }
  size_t in_image = 0;
  size_t visible = 0;
  for (int i = 0; i < 40; ++i) {
    const Rigid3 cam_from_world = random.Pose(3.0, 1.0);
    const std::vector<ObjectId> found = Visible(cam_from_world);
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
    visible += found.size();
    for (const auto& [id, object] : map_.objects()) {
      const auto ellipse =
          ProjectEllipsoid(sensor_.camera.Matrix(), cam_from_world, object.ellipsoid);
      if (ellipse && IsInImage(ellipse->Polygon(32))) {
        ++in_image;
        EXPECT_TRUE(std::binary_search(found.begin(), found.end(), id));
      }
    }
  }
  EXPECT_GT(in_image, 50u);
  EXPECT_LT(visible, 40u * 60u) << "it leaves out some";
}

TEST_F(ObjectIndexTest, FollowsSnapshots) {
  const Rigid3 here = CameraOnCircle(0.0, 1.5, 0.5);
  ObjectIndex index;
  EXPECT_TRUE(index.FindVisible(sensor_, here, IslandId(0)).empty());
  const ObjectId id = Add(cup_, here, true);
  const Map first = map_.Snapshot();
  index.Follow(first, sensor_.camera);
  EXPECT_EQ(index.FindVisible(sensor_, here, IslandId(0)), std::vector<ObjectId>{id});
  map_.EraseObject(id);
  index.Follow(first, sensor_.camera);
  EXPECT_EQ(index.FindVisible(sensor_, here, IslandId(0)), std::vector<ObjectId>{id});
  index.Follow(map_.Snapshot(), sensor_.camera);
  EXPECT_TRUE(index.FindVisible(sensor_, here, IslandId(0)).empty());
}

TEST_F(ObjectIndexTest, FindsObjectsOfTheIslandOfTheCameraOnly) {
  const Rigid3 here = CameraOnCircle(0.0, 1.5, 0.5);
  const ObjectId first = Add(cup_, here, true);
  const ObjectId second = Add(cup_, here, true);
  map_.MoveToIsland(map_.objects().At(second).reference, map_.BeginIsland());
  EXPECT_EQ(Visible(here), std::vector<ObjectId>{first});
  EXPECT_EQ(ObjectIndex(map_, sensor_.camera).FindVisible(sensor_, here, IslandId(1)),
            std::vector<ObjectId>{second});
}

}  // namespace
}  // namespace hullslam
