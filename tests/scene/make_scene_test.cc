// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/make_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "scene/made_scene.h"

namespace hullslam {
namespace {

class MakeSceneTest : public ::testing::Test {
 protected:
  MakeSceneTest() : map_(MakeMapOf(Objects(), sensor_)) {}
  static std::vector<MadeObject> Objects() {
    return {Standing("book", {0.0, 0.0, 0.0}, {0.12, 0.15, 0.03}),
            Standing("cup", {0.0, 0.02, 0.06}, {0.05, 0.05, 0.06}),
            Standing("bottle", {0.3, 0.0, 0.0}, {0.04, 0.04, 0.12})};
  }
  Scene Make(const UpDirection& up) const {
    return MakeScene(map_, CollectObjectResults(map_, sensor_.camera), up);
  }

  Sensor sensor_ = MakeObjectSensor();
  Map map_;
};

TEST_F(MakeSceneTest, DescribesTheObjects) {
  const Scene scene = Make({Eigen::Vector3d::UnitZ(), "ground truth"});
  ASSERT_EQ(scene.objects.size(), 3U);
  const SceneObject& cup = scene.objects[1];
  EXPECT_EQ(cup.label, "cup");
  EXPECT_EQ(cup.shares.at("cup"), 1.0);
  EXPECT_EQ(cup.observations, 12U);
  EXPECT_EQ(cup.first_seen, 10.0);
  EXPECT_EQ(cup.last_seen, 21.0);
  ASSERT_TRUE(cup.box && cup.covariance);
  EXPECT_NEAR(cup.box->half_extents.z(), 0.06, 0.005);
  EXPECT_TRUE(cup.covariance->axes[2].is_round);
  EXPECT_FALSE(cup.covariance->axes[0].is_undetermined);
  // The cameras look down on it at 27 degrees, so their lines limit its sides and its top.
  EXPECT_EQ(cup.box->is_seen, (std::array{true, true, true, true, true, true}));
}

TEST_F(MakeSceneTest, TheVectorOfAnObjectIsTheMeanOfItsMasksWeightedByTheirScores) {
  for (uint32_t i = 0; i < 2; ++i) {
    auto frame = std::make_shared<Frame>(*map_.keyframes().At(KeyframeId(i)).frame);
    frame->id = FrameId(100 + i);
    frame->detections[1].score = i == 0 ? 0.9 : 0.3;
    frame->detections[1].embedding = i == 0 ? std::vector{1.0f, 0.0f} : std::vector{0.0f, 1.0f};
    const KeyframeId keyframe =
        map_.AddKeyframe(frame, map_.keyframes().At(KeyframeId(i)).cam_from_world);
    map_.AddObservation(ObjectId(1), keyframe, 1);
  }
  const Scene scene = Make({std::nullopt, "unknown"});
  EXPECT_TRUE(scene.objects[0].embedding.empty());
  ASSERT_EQ(scene.objects[1].embedding.size(), 2U);
  EXPECT_NEAR(scene.objects[1].embedding[0], 3.0 / std::sqrt(10.0), 1e-6);
  EXPECT_NEAR(scene.objects[1].embedding[1], 1.0 / std::sqrt(10.0), 1e-6);
}

TEST_F(MakeSceneTest, FindsWhatIsOnWhat) {
  const Scene scene = Make({Eigen::Vector3d::UnitZ(), "ground truth"});
  EXPECT_TRUE(std::any_of(scene.relations.begin(), scene.relations.end(), [](const auto& found) {
    return found.subject == ObjectId(1) && found.kind == RelationKind::kOn &&
           found.object == ObjectId(0);
  }));
  ASSERT_EQ(scene.surfaces.size(), 1U);
  EXPECT_EQ(scene.surfaces[0].objects, (std::vector<ObjectId>{ObjectId(0), ObjectId(2)}));
}

TEST_F(MakeSceneTest, WithoutUpwardDirectionHasNoRelationsThatNeedIt) {
  const Scene scene = Make({std::nullopt, "unknown: no ground truth, and too few landmarks"});
  EXPECT_FALSE(scene.objects[0].box);
  EXPECT_TRUE(scene.surfaces.empty());
  for (const Relation& relation : scene.relations) {
    EXPECT_TRUE(relation.kind == RelationKind::kInFrontOf ||
                relation.kind == RelationKind::kHiddenBy);
  }
}

}  // namespace
}  // namespace hullslam
