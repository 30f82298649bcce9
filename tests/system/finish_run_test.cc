// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/finish_run.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "map/islands.h"
#include "map/made_map.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

// A pipeline whose stages have done their work.
class FinishedPipeline : public Pipeline {
 public:
  FinishedPipeline(Map map, Map left) : map_(std::make_shared<const Map>(std::move(map))) {
    left_.push_back(std::make_shared<const Map>(std::move(left)));
  }

  using Pipeline::Finish;
  using Pipeline::TakeEarlyFrames;
  void Begin(PipelineStart) override {}
  void SetLocalizationOnly(bool) override {}
  void AwaitMasks(bool /*is_on*/) override {}
  void Edit(MapMessage /*message*/) override {}
  void KeepIdsSince(uint32_t /*revision*/) override {}
  FrameReport Track(std::shared_ptr<const Frame>) override { return {}; }
  void Finish(const Cancellation*, const ProgressCallback&) override {}
  std::vector<TrackedFrame> TakeEarlyFrames(const Cancellation*, const ProgressCallback&) override {
    return {};
  }
  std::shared_ptr<const Map> map() const override { return map_; }
  int busy_threads() const override { return 0; }
  StageTimes times() const override { return {}; }
  std::map<ObjectRejection, size_t> object_rejections() const override { return {}; }
  const std::vector<ChangedObject>& object_changes() const override { return changes_; }
  size_t contradicted_landmarks() const override { return 0; }
  const std::vector<std::shared_ptr<const Map>>& left_islands() const override { return left_; }

 private:
  std::shared_ptr<const Map> map_;
  std::vector<std::shared_ptr<const Map>> left_;
  std::vector<ChangedObject> changes_;
};

// Frame 1 was tracked in an island that was not joined to the map, frame 4 in the main island.
TEST(FinishRun, FramesOfAnIslandThatIsLeftAreLostInTheMap) {
  Map map;
  const IslandId other = map.BeginIsland();
  const IslandId main = map.BeginIsland();
  const KeyframeId elsewhere = map.AddKeyframe(MakeFrame(1, 1), Rigid3(), other);
  const KeyframeId inside = map.AddKeyframe(MakeFrame(4, 1), Rigid3(), main);
  map.AddKeyframe(MakeFrame(7, 1), Rigid3(), main);
  Map left = map.Snapshot();
  KeepOnlyIsland(left, other);
  KeepOnlyIsland(map, main);
  std::vector<TrackedFrame> frames(2);
  for (uint32_t i = 0; i < 2; ++i) {
    frames[i].frame = FrameId(i == 0 ? 2 : 5);
    frames[i].timestamp = frames[i].frame.value;
    frames[i].state = TrackingState::kTracked;
    frames[i].from_keyframe = RelativePose{i == 0 ? elsewhere : inside, Rigid3(), 1.0};
  }
  FinishedPipeline pipeline(std::move(map), std::move(left));
  const SyntheticWorld world;
  const std::vector<LeftIsland> islands =
      FinishRun(pipeline, world.sensor(), SystemOptions(), {}, frames, nullptr, {}, {});
  EXPECT_EQ(frames[0].state, TrackingState::kLost);
  EXPECT_FALSE(frames[0].from_keyframe);
  EXPECT_EQ(frames[1].state, TrackingState::kTracked);
  ASSERT_EQ(islands.size(), 1U);
  ASSERT_EQ(islands[0].trajectory.size(), 1U);
  EXPECT_EQ(islands[0].trajectory[0].timestamp, 2.0);
}

TEST(CountObjects, EachReasonOfMasksAndObjectsHasANameOfItsOwn) {
  DetectionCounts masks;
  masks.detections = 7;
  masks.frames_with_masks = 3;
  std::map<ObjectRejection, size_t> rejections;
  size_t expected = 0;
  for (int i = 0; i < kDetectionRejectionCount; ++i) {
    masks.rejections[static_cast<DetectionRejection>(i)] = static_cast<size_t>(i) + 1;
    expected += static_cast<size_t>(i) + 1;
  }
  for (int i = 0; i < kObjectRejectionCount; ++i) {
    rejections[static_cast<ObjectRejection>(i)] = static_cast<size_t>(i) + 10;
    expected += static_cast<size_t>(i) + 10;
  }
  const ObjectCounts counts = CountObjects(masks, 10, rejections);
  EXPECT_EQ(counts.detections, 7u);
  EXPECT_EQ(counts.frames_with_masks, 3u);
  EXPECT_EQ(counts.frames_without_masks, 7u);
  EXPECT_EQ(counts.rejections.size(),
            static_cast<size_t>(kDetectionRejectionCount + kObjectRejectionCount));
  size_t sum = 0;
  for (const auto& [reason, count] : counts.rejections) {
    sum += count;
  }
  EXPECT_EQ(sum, expected);
  EXPECT_EQ(counts.rejections.at("mask_low_score"), 1u);
  EXPECT_EQ(counts.rejections.at("few_views"), 10u);
}

}  // namespace
}  // namespace hullslam
