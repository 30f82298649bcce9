// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/loop_stages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <future>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

#include "map/made_correction.h"
#include "mapping/mapper.h"
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

TEST_F(StartNextStageTest, AnEditOfAnObjectStartsNothing) {
  EXPECT_TRUE(Start(ObjectEdit{.object = ObjectId(0), .name = "a"}).sought.empty());
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

// Collects the corrections that are sent. A test can keep it in its first call until it releases
// it.
class Receiver {
 public:
  ~Receiver() { LetGo(); }
  void Block() { is_blocking_ = true; }
  void WaitUntilBlocked() { is_blocked_.get_future().wait(); }
  void LetGo() {
    if (!std::exchange(is_free_, true)) {
      go_.set_value();
    }
  }

  void Receive(MapCorrection correction) {
    bool is_first = false;
    bool is_loop = false;
    {
      const std::lock_guard lock(mutex_);
      is_loop = correction.loop.has_value();
      is_first = sent_.empty();
      sent_.push_back(std::move(correction));
    }
    if (is_blocking_ && is_first) {
      is_blocked_.set_value();
      go_.get_future().wait();
    } else if (is_blocking_ && is_loop) {
      has_loop_.set_value();
    }
  }
  // Waits for a loop after the first call.
  void WaitForLoop() { has_loop_.get_future().wait(); }

  std::vector<MapCorrection> sent() const {
    const std::lock_guard lock(mutex_);
    return sent_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<MapCorrection> sent_;
  bool is_blocking_ = false;
  bool is_free_ = false;
  std::promise<void> is_blocked_;
  std::promise<void> go_;
  std::promise<void> has_loop_;
};

class LoopThreadsTest : public testing::Test {
 protected:
  LoopThreadsTest() { options_.vocabulary = SharedRing().vocabulary(); }
  std::unique_ptr<LoopThreads> Make() {
    return std::make_unique<LoopThreads>(
        SharedRing().sensor(), options_,
        [this](MapCorrection correction) { receiver_.Receive(std::move(correction)); });
  }
  LoopQuery Query(KeyframeId keyframe) { return {made_.map.Snapshot(), keyframe}; }
  // A keyframe at the pose of the last one.
  KeyframeRequest RequestAtLast(FrameId id) const {
    const SyntheticView view =
        SharedRing().Observe(id, made_.true_cam_from_world[made_.last().value]);
    KeyframeRequest request;
    request.frame = view.frame;
    request.pose = made_.map.RelativeTo(made_.last(), made_.map.CamFromWorld(made_.last()));
    const std::vector<uint32_t>& known = made_.views.back().points;
    const std::vector<LandmarkId>& landmarks = made_.map.keyframes().At(made_.last()).landmarks;
    for (const uint32_t point : view.points) {
      const auto found = std::find(known.begin(), known.end(), point);
      request.landmarks.push_back(found != known.end()
                                      ? landmarks[static_cast<size_t>(found - known.begin())]
                                      : LandmarkId());
    }
    return request;
  }
  std::shared_ptr<const Map> Published() {
    return std::make_shared<const Map>(made_.map.Snapshot());
  }

  SystemOptions options_;
  RingMap made_ = MakeRingMap(SharedRing());
  Receiver receiver_;
};

TEST_F(LoopThreadsTest, SettleWaitsForTheLoopThatIsSought) {
  const auto threads = Make();
  threads->Seek(Query(made_.last()));
  EXPECT_TRUE(threads->Settle(false));
  ASSERT_EQ(receiver_.sent().size(), 1u);
  EXPECT_TRUE(receiver_.sent()[0].loop);
  EXPECT_EQ(threads->busy_threads(), 0);
  EXPECT_FALSE(threads->Settle(false)) << "nothing was sent since the last call";
  EXPECT_EQ(threads->times().samples().at("loop_detection").size(), 1u);
}

TEST_F(LoopThreadsTest, NothingIsSentWhereThereIsNoLoop) {
  const auto threads = Make();
  threads->Seek(Query(KeyframeId(14)));
  EXPECT_FALSE(threads->Settle(false));
  EXPECT_TRUE(receiver_.sent().empty());
}

TEST_F(LoopThreadsTest, SettleWaitsForTheAdjustment) {
  const auto threads = Make();
  threads->Adjust(Published());
  EXPECT_TRUE(threads->Settle(false));
  ASSERT_EQ(receiver_.sent().size(), 1u);
  EXPECT_FALSE(receiver_.sent()[0].loop);
  EXPECT_FALSE(receiver_.sent()[0].positions.empty());
  EXPECT_EQ(threads->times().samples().at("loop_adjustment").size(), 1u);
}

// The next loop corrects the map, so that an adjustment of the former map would be refused.
TEST_F(LoopThreadsTest, TheNextLoopGivesUpTheAdjustment) {
  receiver_.Block();
  const auto threads = Make();
  threads->Adjust(Published());
  receiver_.WaitUntilBlocked();  // the first adjustment is being sent
  EXPECT_EQ(threads->busy_threads(), 1);
  threads->Adjust(Published());  // the second one waits
  threads->Seek(Query(made_.last()));
  receiver_.WaitForLoop();
  receiver_.LetGo();
  EXPECT_TRUE(threads->Settle(false));
  const std::vector<MapCorrection> sent = receiver_.sent();
  ASSERT_EQ(sent.size(), 2u);
  EXPECT_FALSE(sent[0].loop);
  EXPECT_TRUE(sent[1].loop);
}

TEST_F(LoopThreadsTest, ALoopThatTheMapperHasDroppedIsSoughtAgain) {
  MappingOptions mapping;
  mapping.cull_keyframes = false;
  std::shared_ptr<const Map> published;
  Mapper mapper(
      SharedRing().sensor(), mapping, ObjectOptions(),
      [&](std::shared_ptr<const Map> map) { published = std::move(map); }, options_.vocabulary);
  mapper.Begin(made_.map.Snapshot(), {.name = "next", .first_frame = FrameId(200)});
  const auto threads = Make();
  const auto process = [&](const MapMessage& message) {
    const bool is_applied = mapper.Process(message, nullptr);
    StartNextStage(message, is_applied, options_, mapper, published, *threads);
    return is_applied;
  };
  EXPECT_TRUE(process(RequestAtLast(FrameId(200))));
  EXPECT_TRUE(threads->Settle(false));
  EXPECT_TRUE(mapper.Process(MakeIdentity(mapper.Snapshot()), nullptr));
  ASSERT_EQ(receiver_.sent().size(), 1u);
  EXPECT_FALSE(process(receiver_.sent()[0]));
  EXPECT_TRUE(threads->Settle(false)) << "the loop is found again";
  ASSERT_EQ(receiver_.sent().size(), 2u);
  EXPECT_TRUE(receiver_.sent()[1].loop);
  EXPECT_TRUE(process(receiver_.sent()[1]));
  EXPECT_TRUE(threads->Settle(false)) << "the map is adjusted";
  EXPECT_TRUE(process(receiver_.sent()[2]));
  EXPECT_FALSE(process(receiver_.sent()[2])) << "a dropped adjustment";
  EXPECT_FALSE(threads->Settle(false)) << "needs no new search";
}

TEST_F(LoopThreadsTest, MayBeDestroyedWhileTheyWork) {
  for (int i = 0; i < 3; ++i) {
    const auto threads = Make();
    threads->Seek(Query(made_.last()));
    threads->Adjust(Published());
  }
}

TEST_F(LoopThreadsTest, AnExceptionReachesTheCaller) {
  LoopThreads threads(SharedRing().sensor(), options_,
                      [](const MapCorrection&) { throw std::runtime_error("full"); });
  EXPECT_NO_THROW(threads.RethrowFailure());
  threads.Seek(Query(made_.last()));
  threads.Settle(false);
  EXPECT_THROW(threads.RethrowFailure(), std::runtime_error);
  LoopThreads others(SharedRing().sensor(), options_,
                     [](const MapCorrection&) { throw std::runtime_error("full"); });
  others.Adjust(Published());
  others.Settle(false);
  EXPECT_THROW(others.RethrowFailure(), std::runtime_error);
}

}  // namespace
}  // namespace hullslam
