// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/view_of_map.h"

#include <gtest/gtest.h>

#include <string>

#include "support/made_view.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

class ViewOfMapTest : public ::testing::Test {
 protected:
  SyntheticWorld world_;
  SyntheticMap made_ = MakeSyntheticMap(world_, {0, 10, 20});
};

TEST_F(ViewOfMapTest, HasTheLandmarksAndKeyframesOfTheMap) {
  const ViewModel model = ViewOfMap(made_.map, world_.sensor(), {});
  const auto& [id, landmark] = *made_.map.landmarks().begin();
  ASSERT_EQ(model.landmarks.positions.size(), made_.map.landmarks().size());
  EXPECT_EQ(model.landmarks.total, made_.map.landmarks().size());
  EXPECT_EQ(model.landmarks.positions[0], landmark.position.cast<float>());
  EXPECT_EQ(model.landmarks.created[0],
            made_.map.keyframes().At(landmark.created_by).frame->timestamp);
  ASSERT_EQ(model.keyframes.poses.size(), 3u);
  EXPECT_EQ(model.keyframes.ids, (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_EQ(model.trajectory.size(), 3u);
  EXPECT_TRUE(model.is_metric);
  ASSERT_TRUE(model.camera);
  EXPECT_EQ(*model.camera, world_.sensor().camera);
}

TEST_F(ViewOfMapTest, HasEachEdgeOnce) {
  made_.map.AddLoop(KeyframeId(2), KeyframeId(0));
  const ViewModel model = ViewOfMap(made_.map, world_.sensor(), {});
  EXPECT_EQ(model.edges.loops, (std::vector<ViewEdges::Edge>{{0, 2}}));
  for (const ViewEdges::Edge& edge : model.edges.covisibility) {
    EXPECT_LT(edge[0], edge[1]);
  }
  EXPECT_FALSE(model.edges.covisibility.empty());
}

TEST_F(ViewOfMapTest, SaysWhyACandidateIsNotMapped) {
  const ObjectId object = made_.map.AddObject();
  ViewModel model;
  model.objects.push_back({MadeSphere(object.value, "cup"), {}, {}});
  AddMap(made_.map, world_.sensor(), {}, model);
  EXPECT_EQ(model.objects[0].reason, "0 keyframes, expected at least 3");
}

}  // namespace
}  // namespace hullslam
