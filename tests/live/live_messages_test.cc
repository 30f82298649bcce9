// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_messages.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "scene/made_scene.h"
#include "support/made_live.h"

namespace hullslam {
namespace {

using Json = nlohmann::json;

class LiveMessagesTest : public ::testing::Test {
 protected:
  LiveState StateAfter(uint32_t frames) const {
    LiveInbox inbox;
    for (uint32_t index = 0; index < frames; ++index) {
      LiveFrame frame = MadeLiveFrame(world_, index, map_);
      frame.report.tracked.from_keyframe =
          map_->RelativeTo(KeyframeId(0), frame.report.tracked.cam_from_world);
      inbox.Put(std::move(frame));
    }
    return inbox.state();
  }

  SyntheticWorld world_;
  std::shared_ptr<const Map> map_ =
      std::make_shared<const Map>(MakeSyntheticMap(world_, {0, 10, 20}).map.Snapshot());
  LiveMessages messages_{MadeLiveRun(world_), {}};
};

TEST_F(LiveMessagesTest, AFrameIsOneLineWithStateAndImage) {
  const LiveFrame frame = MadeLiveFrame(world_, 4, map_);
  const std::string text = messages_.Frame(&frame, {.notice = "<b>\nsaved"}, 31.24);
  EXPECT_EQ(text.find_first_of("\n\r<"), std::string::npos);
  const Json message = Json::parse(text);
  EXPECT_EQ(message["view"], 1);
  const Json& live = message["set"]["live"];
  EXPECT_EQ(live["state"], "tracked");
  EXPECT_EQ(live["phase"], "running");
  EXPECT_EQ(live["frame"], 5);
  EXPECT_EQ(live["frames"], 200);
  EXPECT_EQ(live["inliers"], 123);
  EXPECT_EQ(live["rate"], 31.2);
  EXPECT_EQ(live["notice"], "<b>?saved");
  EXPECT_EQ(live["pose"].size(), 7u);
  EXPECT_EQ(message["set"]["live_image"]["width"], 480);
  EXPECT_TRUE(message["set"]["live_image"]["matched"].contains("f32"));
}

TEST_F(LiveMessagesTest, AStateWithoutAFrameKeepsThatOfTheLastOne) {
  const LiveFrame frame = MadeLiveFrame(world_, 4, map_);
  messages_.Frame(&frame, {}, 0.0);
  const Json message = Json::parse(messages_.Frame(nullptr, {.phase = LivePhase::kPaused}, 0.0));
  EXPECT_EQ(message["set"]["live"]["frame"], 5);
  EXPECT_EQ(message["set"]["live"]["phase"], "paused");
  EXPECT_FALSE(message["set"].contains("live_image"));
}

TEST_F(LiveMessagesTest, ALostFrameHasItsReasonAndNoPose) {
  LiveFrame frame = MadeLiveFrame(world_, 4, map_);
  frame.report.tracked.state = TrackingState::kLost;
  frame.report.loss = TrackingFailure{};
  const Json live = Json::parse(messages_.Frame(&frame, {}, 0.0))["set"]["live"];
  EXPECT_EQ(live["state"], "lost");
  EXPECT_EQ(live["reason"], ToString(TrackingFailure{}));
  EXPECT_FALSE(live.contains("pose"));
}

TEST_F(LiveMessagesTest, ChangesOfTheMapAreOnlySentOnce) {
  const LiveState state = StateAfter(5);
  const auto first = messages_.MapChange(state, true);
  ASSERT_TRUE(first);
  const Json message = Json::parse(*first);
  EXPECT_EQ(message["patch"]["landmarks"]["count"], map_->landmarks().size());
  EXPECT_EQ(message["patch"]["keyframes"]["count"], 3);
  EXPECT_TRUE(message["set"].contains("trajectory"));
  EXPECT_FALSE(messages_.MapChange(state, true));
  const Json next = Json::parse(messages_.MapChange(StateAfter(8), true).value());
  EXPECT_FALSE(next.contains("patch"));
  EXPECT_TRUE(next["add"].contains("trajectory"));
}

TEST_F(LiveMessagesTest, TheWholeHasAllPartsAndSaysThatTheRunGoesOn) {
  messages_.MapChange(StateAfter(5), false);
  const Json set = Json::parse(messages_.Whole({}))["set"];
  for (const char* part : {"run", "camera", "landmarks", "keyframes", "trajectory", "objects",
                           "edges", "summary", "losses"}) {
    EXPECT_TRUE(set.contains(part)) << part;
  }
  EXPECT_EQ(set["run"]["live"], true);
  EXPECT_EQ(set["run"]["title"], "made <run>");
  EXPECT_EQ(set["landmarks"]["total"], map_->landmarks().size());
  EXPECT_EQ(set["summary"]["map"]["keyframes"], 3);
  messages_.SetSummary({{"trajectory", {{"ate_rmse_m", 0.01}}}});
  const Json end = Json::parse(messages_.Whole({.phase = LivePhase::kEnded}))["set"];
  EXPECT_EQ(end["run"]["live"], false);
  EXPECT_EQ(end["summary"]["trajectory"]["ate_rmse_m"], 0.01);
}

TEST(LiveBoxes, ObjectsGetTheirBoxesWhenTheMapRests) {
  const Sensor sensor = MakeObjectSensor();
  LiveState state;
  state.map = std::make_shared<const Map>(
      MakeMapOf({Standing("book", {0.0, 0.0, 0.0}, {0.12, 0.15, 0.03})}, sensor));
  LiveRun run;
  run.sensor = sensor;
  state.map->keyframes().ForEach([&](KeyframeId, const Keyframe& keyframe) {
    run.groundtruth.push_back({keyframe.frame->timestamp, Inverse(keyframe.cam_from_world)});
  });
  LiveMessages messages(run, {});
  const auto object_of = [](const std::optional<std::string>& change, const char* part) {
    return Json::parse(change.value_or("{}"))[part]["objects"][0];
  };
  EXPECT_TRUE(object_of(messages.MapChange(state, true), "add")["body"].is_null());
  const Json at_rest = object_of(messages.MapChange(state, true, true), "set");
  EXPECT_NEAR(at_rest["body"]["box"]["half_extents"][2].get<double>(), 0.03, 0.01);
  EXPECT_EQ(object_of(messages.Whole({}), "set")["body"], at_rest["body"]);
  EXPECT_FALSE(messages.MapChange(state, true, true)) << "they are sent once";
}

TEST_F(LiveMessagesTest, GroundTruthIsAlignedToThePath) {
  LiveRun run = MadeLiveRun(world_);
  for (uint32_t index = 0; index < 100; ++index) {
    const LiveFrame frame = MadeLiveFrame(world_, index, map_);
    run.groundtruth.push_back(
        {frame.report.tracked.timestamp, frame.report.tracked.world_from_cam()});
  }
  LiveMessages messages(run, {});
  const Json message = Json::parse(messages.MapChange(StateAfter(40), true).value());
  EXPECT_TRUE(message["set"].contains("groundtruth"));
  EXPECT_TRUE(message["set"].contains("errors"));
  EXPECT_TRUE(message["set"].contains("up"));
  // A few more frames are not worth another alignment, but the curve of a run that rests is whole.
  const auto has_errors = [&](const std::optional<std::string>& change) {
    return Json::parse(change.value_or("{}")).value("set", Json::object()).contains("errors");
  };
  EXPECT_FALSE(has_errors(messages.MapChange(StateAfter(43), true)));
  EXPECT_TRUE(has_errors(messages.MapChange(StateAfter(43), true, true)));
  EXPECT_FALSE(has_errors(messages.MapChange(StateAfter(43), true, true)));
}

}  // namespace
}  // namespace hullslam
