// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/threaded_pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>
#include <string>
#include <thread>

#include "hullslam/util/check.h"
#include "map/invariants.h"
#include "system/pipeline_cases.h"
#include "system/ring_path.h"

namespace hullslam {
namespace {

// While it exists, only the thread that made it gets memory.
class MemoryShortage {
 public:
  MemoryShortage() {
    is_spared_thread = true;
    is_short = true;
  }
  ~MemoryShortage() { is_short = false; }
  MemoryShortage(const MemoryShortage&) = delete;
  MemoryShortage& operator=(const MemoryShortage&) = delete;

  static void* Allocate(size_t size) {
    void* const memory = is_short && !is_spared_thread ? nullptr : std::malloc(size);
    if (memory == nullptr) {
      throw std::bad_alloc();
    }
    return memory;
  }

 private:
  static inline std::atomic<bool> is_short{false};
  static inline thread_local bool is_spared_thread = false;
};

TEST(ThreadedPipeline, AShortageOfMemoryInMappingIsThrownByTrack) {
  const SyntheticWorld world = NoisyWorld();
  const SystemOptions options;
  const auto pipeline = MakeThreadedPipeline(world.sensor(), options, Pace::kWaitForMapper);
  TrackPath(*pipeline, world, 0, 4);
  {
    const MemoryShortage shortage;
    EXPECT_THROW(TrackPath(*pipeline, world, 4, 60), std::bad_alloc);
  }
  EXPECT_THROW(pipeline->Finish(), std::bad_alloc);
}

TEST(ThreadedPipeline, TheFirstKeyframeIsInTheMapWhenTrackReturns) {
  const SyntheticWorld world = NoisyWorld();
  const SystemOptions options;
  for (const Pace pace : {Pace::kWaitForMapper, Pace::kNeverWait}) {
    const auto pipeline = MakeThreadedPipeline(world.sensor(), options, pace);
    pipeline->Track(world.Observe(0).frame);
    ASSERT_NE(pipeline->map(), nullptr) << "there is nothing to track against before";
    EXPECT_GT(pipeline->map()->landmarks().size(), 100u);
  }
}

TEST(ThreadedPipeline, WaitingForTheMapperLeavesOutNoKeyframe) {
  const SyntheticWorld world = NoisyWorld();
  const SystemOptions options;
  const auto pipeline = MakeThreadedPipeline(world.sensor(), options, Pace::kWaitForMapper);
  for (uint32_t i = 0; i < 60; ++i) {
    const uint32_t before = i == 0 ? 0 : pipeline->map()->keyframes().NextId().value;
    pipeline->Track(PathFrame(world, i));
    const auto map = pipeline->map();
    if (map->keyframes().NextId().value > before) {
      EXPECT_EQ(map->KeyframeOfFrame(FrameId(i)), KeyframeId(before))
          << "a keyframe is in the map when the Track that asked for it returns";
    }
  }
}

TEST(ThreadedPipeline, FinishProcessesTheKeyframesThatWait) {
  const SyntheticWorld world = NoisyWorld();
  const SystemOptions options;
  const auto pipeline = MakeThreadedPipeline(world.sensor(), options, Pace::kNeverWait);
  const std::vector<TrackedFrame> frames = TrackPath(*pipeline, world, 0, 60);
  pipeline->Finish();
  const auto map = pipeline->map();
  EXPECT_EQ(FindViolations(*map), std::vector<std::string>());
  for (const TrackedFrame& frame : frames) {
    if (frame.from_keyframe) {
      EXPECT_LT(frame.from_keyframe->reference.value, map->keyframes().NextId().value);
    } else {
      EXPECT_TRUE(map->KeyframeOfFrame(frame.frame));
    }
  }
}

// Without synchronisation, the thread sanitizer finds a data race here.
TEST(ThreadedPipeline, TimesAndRejectionsMayBeReadDuringTracking) {
  const SyntheticWorld world = NoisyWorld();
  const SystemOptions options;
  const auto pipeline = MakeThreadedPipeline(world.sensor(), options, Pace::kNeverWait);
  size_t inserted = 0;
  for (uint32_t i = 0; i < 60; ++i) {
    pipeline->Track(PathFrame(world, i));
    EXPECT_TRUE(pipeline->object_rejections().empty());
    const StageTimes times = pipeline->times();
    EXPECT_EQ(times.samples().at("pose").size(), i + 1);
    if (const auto found = times.samples().find("map_insert"); found != times.samples().end()) {
      EXPECT_GE(found->second.size(), inserted);
      inserted = found->second.size();
    }
  }
  pipeline->Finish();
  EXPECT_EQ(pipeline->times().samples().at("map_insert").size(),
            pipeline->map()->keyframes().NextId().value);
}

TEST(ThreadedPipeline, AfterAFailureNothingMoreIsMapped) {
  const FailingMapping failing;
  const SystemOptions options;
  // A mapper that must hurry would leave out what fails, and tracking might fail before it.
  const auto pipeline = MakeThreadedPipeline(failing.sensor, options, Pace::kWaitForMapper);
  pipeline->Track(failing.first);
  pipeline->Track(failing.second);
  // Waits until mapping has failed.
  const auto track_on = [&] {
    for (uint32_t i = 2; i <= 100'000; ++i) {
      auto frame = std::make_shared<Frame>(*failing.second);
      frame->id = FrameId(i);
      pipeline->Track(frame);
    }
  };
  EXPECT_THROW(track_on(), CheckError);
  const auto map = pipeline->map();
  EXPECT_THROW(track_on(), CheckError);
  EXPECT_THROW(pipeline->Finish(), CheckError);
  EXPECT_EQ(pipeline->map(), map);
  EXPECT_FALSE(pipeline->times().samples().contains("global_bundle_adjustment"));
}

TEST(ThreadedPipeline, AFailureOfMappingIsThrownByTheNextTrack) {
  const FailingMapping failing;
  const SystemOptions options;
  const auto pipeline = MakeThreadedPipeline(failing.sensor, options, Pace::kWaitForMapper);
  pipeline->Track(failing.first);
  // The keyframe is published before mapping fails, so the next call may come first.
  const auto track_on = [&] {
    for (uint32_t i = 1; i <= 1000; ++i) {
      auto frame = std::make_shared<Frame>(*failing.second);
      frame->id = FrameId(i);
      pipeline->Track(frame);
    }
  };
  EXPECT_THROW(track_on(), CheckError);
}

// The run ends soon after the keyframe that closes the loop. At that time the loop is still
// searched, or the whole map is being adjusted.
TEST(ThreadedPipeline, FinishWaitsForTheLastLoop) {
  RingPath path;
  path.options().mapping.final_bundle_adjustment = false;
  const auto pipeline = MakeThreadedPipeline(path.sensor(), path.options(), Pace::kWaitForMapper);
  path.Track(*pipeline, 0, path.FirstLoop() + 10);
  pipeline->Finish();
  EXPECT_GE(RingPath::CountLoopEnds(*pipeline->map()), 2);
  EXPECT_EQ(pipeline->map()->correction_count(), 2u) << "the loop and the adjustment";
  EXPECT_EQ(pipeline->busy_threads(), 0);
  EXPECT_EQ(pipeline->times().samples().at("loop_adjustment").size(), 1u);
}

TEST(ThreadedPipeline, AFinalAdjustmentReplacesThatOfTheLastLoop) {
  RingPath path;
  path.options().mapping.final_bundle_adjustment = true;
  const auto pipeline = MakeThreadedPipeline(path.sensor(), path.options(), Pace::kWaitForMapper);
  path.Track(*pipeline, 0, path.FirstLoop() + 10);
  pipeline->Finish();
  EXPECT_GE(RingPath::CountLoopEnds(*pipeline->map()), 2);
  EXPECT_EQ(pipeline->busy_threads(), 0);
  EXPECT_EQ(pipeline->times().samples().at("global_bundle_adjustment").size(), 1u);
}

TEST(ThreadedPipeline, OtherThreadsMayReadTheMapDuringTracking) {
  const SyntheticWorld world = NoisyWorld();
  const SystemOptions options;
  const auto pipeline = MakeThreadedPipeline(world.sensor(), options, Pace::kNeverWait);
  pipeline->Track(world.Observe(0).frame);
  std::atomic<bool> is_over{false};
  std::vector<std::string> violations;
  size_t newest = 0;
  std::thread reader([&] {
    while (!is_over) {
      const auto map = pipeline->map();
      const std::vector<std::string> found = FindViolations(*map);
      violations.insert(violations.end(), found.begin(), found.end());
      newest = std::max<size_t>(newest, map->keyframes().NextId().value);
    }
  });
  TrackPath(*pipeline, world, 1, 60);
  pipeline->Finish();
  is_over = true;
  reader.join();
  EXPECT_EQ(violations, std::vector<std::string>());
  EXPECT_GE(newest, 1u);
}

}  // namespace
}  // namespace hullslam

// If GCC inlines only some of these, it warns that they do not belong together.
[[gnu::noinline]] void* operator new(size_t size) {
  return hullslam::MemoryShortage::Allocate(size);
}
[[gnu::noinline]] void* operator new(size_t size, const std::nothrow_t& /*tag*/) noexcept {
  return std::malloc(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, size_t /*size*/) noexcept {
  std::free(memory);
}
