// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/loop_stages.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "support/ring_world.h"

namespace hullslam {
namespace {

// Remembers which stages were started.
class RecordingStages final : public LoopStages {
 public:
  void Seek(LoopQuery query) override { sought.push_back(query.keyframe); }
  void Adjust(std::shared_ptr<const Map> corrected) override {
    adjusted.push_back(std::move(corrected));
  }

  std::vector<KeyframeId> sought;
  std::vector<std::shared_ptr<const Map>> adjusted;
};

// A mapper whose map begins with one frame of the ring world.
class StartNextStageTest : public testing::Test {
 protected:
  StartNextStageTest() {
    options_.vocabulary = SharedRing().vocabulary();
    mapper_.Process(first_, nullptr);
  }

  static InitialMap MakeFirst() {
    InitialMap initial;
    const SyntheticView view = SharedRing().Observe(FrameId(0), Rigid3());
    for (uint32_t keypoint = 0; keypoint < view.points.size(); ++keypoint) {
      initial.points.push_back({.position = SharedRing().point(view.points[keypoint]),
                                .observations = {{.view = 0, .keypoint = keypoint}}});
    }
    initial.views.push_back({.frame = view.frame, .cam_from_world = Rigid3()});
    return initial;
  }
  MapCorrection Correction(bool has_loop) const {
    MapCorrection correction;
    correction.snapshot_corrections = published_->correction_count();
    if (has_loop) {
      correction.loop = MapCorrection::LoopEdge{KeyframeId(0), KeyframeId(0)};
    }
    return correction;
  }
  RecordingStages Start(const MapMessage& message, bool is_applied = true) {
    RecordingStages stages;
    StartNextStage(message, is_applied, options_, mapper_, published_, stages);
    return stages;
  }

  SystemOptions options_;
  std::shared_ptr<const Map> published_;
  Mapper mapper_{SharedRing().sensor(),
                 {},
                 {},
                 [this](std::shared_ptr<const Map> map) { published_ = std::move(map); },
                 SharedRing().vocabulary()};
  const MapMessage first_ = MakeFirst();
};

TEST_F(StartNextStageTest, SeeksALoopAtTheNewKeyframe) {
  const RecordingStages stages = Start(first_);
  EXPECT_EQ(stages.sought, std::vector<KeyframeId>{KeyframeId(0)});
  EXPECT_TRUE(stages.adjusted.empty());
}

TEST_F(StartNextStageTest, AdjustsTheMapAfterALoop) {
  const RecordingStages stages = Start(Correction(true));
  EXPECT_TRUE(stages.sought.empty());
  EXPECT_EQ(stages.adjusted, std::vector<std::shared_ptr<const Map>>{published_});
}

TEST_F(StartNextStageTest, NothingFollowsTheAdjustment) {
  for (const bool is_applied : {true, false}) {
    const RecordingStages stages = Start(Correction(false), is_applied);
    EXPECT_TRUE(stages.sought.empty());
    EXPECT_TRUE(stages.adjusted.empty());
  }
}

TEST_F(StartNextStageTest, SeeksALoopAgainThatWasDropped) {
  const RecordingStages stages = Start(Correction(true), false);
  EXPECT_EQ(stages.sought, std::vector<KeyframeId>{KeyframeId(0)});
  EXPECT_TRUE(stages.adjusted.empty());
}

TEST_F(StartNextStageTest, WithoutTheOptionTheMapIsNotAdjusted) {
  options_.loop.global_adjustment = false;
  EXPECT_TRUE(Start(Correction(true)).adjusted.empty());
  EXPECT_EQ(Start(first_).sought.size(), 1u);
}

TEST_F(StartNextStageTest, WithoutLoopsOrWordsNothingFollows) {
  options_.loop.enabled = false;
  EXPECT_TRUE(Start(first_).sought.empty());
  EXPECT_TRUE(Start(Correction(true)).adjusted.empty());
  options_.loop.enabled = true;
  options_.vocabulary = nullptr;
  EXPECT_TRUE(Start(first_).sought.empty());
  EXPECT_TRUE(Start(Correction(true)).adjusted.empty());
}

}  // namespace
}  // namespace hullslam
