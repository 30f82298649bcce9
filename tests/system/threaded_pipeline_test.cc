// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <new>
#include <string>
#include <thread>

#include "hullslam/util/check.h"
#include "map_files/invariants.h"
#include "system/pipeline.h"
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

  static bool Applies() { return is_short && !is_spared_thread; }

 private:
  static inline std::atomic<bool> is_short{false};
  static inline thread_local bool is_spared_thread = false;
};

// While it exists, all threads but the one that made it wait when they want memory. So a test can
// stop the mapper in the middle of its work, and decide what happens meanwhile.
class ClosedGate {
 public:
  ClosedGate() {
    is_spared_thread = true;
    const std::lock_guard lock(mutex);
    is_closed = true;
  }
  ~ClosedGate() {
    {
      const std::lock_guard lock(mutex);
      is_closed = false;
    }
    changed.notify_all();
  }
  ClosedGate(const ClosedGate&) = delete;
  ClosedGate& operator=(const ClosedGate&) = delete;

  static void AwaitThread() {
    std::unique_lock lock(mutex);
    changed.wait(lock, [] { return waiting > 0; });
  }

  static void Pass() {
    if (!is_closed || is_spared_thread) {
      return;
    }
    std::unique_lock lock(mutex);
    ++waiting;
    changed.notify_all();
    changed.wait(lock, [] { return !is_closed; });
    --waiting;
  }

 private:
  static inline std::mutex mutex;
  static inline std::condition_variable changed;
  static inline std::atomic<bool> is_closed{false};
  static inline int waiting = 0;
  static inline thread_local bool is_spared_thread = false;
};

void* Allocate(size_t size) {
  ClosedGate::Pass();
  void* const memory = MemoryShortage::Applies() ? nullptr : std::malloc(size);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  return memory;
}

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

// A pipeline whose mapper is stopped when it begins with a keyframe.
class HurryOfTheMapper : public testing::Test {
 protected:
  struct Work {
    size_t keyframes = 0;
    size_t adjustments = 0;
    bool operator==(const Work&) const = default;
  };

  HurryOfTheMapper() {
    for (; next_ < 20; ++next_) {
      TrackNext();
      AwaitMapper();
    }
    EXPECT_GT(pipeline_->map()->keyframes().size(), 2U) << "else nothing is adjusted";
    before_ = CountWork();
  }

  void TrackNext() { pipeline_->Track(PathFrame(world_, next_)); }
  void AwaitMapper() const {
    while (pipeline_->busy_threads() > 0) {
      std::this_thread::yield();
    }
  }
  // Tracks until the mapper has a keyframe to work on. It must be stopped by a ClosedGate.
  void BeginKeyframe() {
    for (const uint32_t end = next_ + 100; next_ < end && pipeline_->busy_threads() == 0; ++next_) {
      TrackNext();
    }
    ASSERT_EQ(pipeline_->busy_threads(), 1);
    ClosedGate::AwaitThread();
  }
  // Tracks so long that the camera leaves what the published map shows.
  void TrackOn() {
    for (const uint32_t end = next_ + 100; next_ < end; ++next_) {
      TrackNext();
    }
  }
  // Masks of frames that are no keyframes, without objects.
  void AddLate(int count) {
    for (int i = 0; i < count; ++i) {
      pipeline_->Edit(LateDetections{.frame = FrameId(1'000'000), .detections = {}});
    }
  }
  Work CountWork() const {
    const StageTimes times = pipeline_->times();
    const auto count = [&](const char* stage) {
      const auto found = times.samples().find(stage);
      return found != times.samples().end() ? found->second.size() : 0;
    };
    return {count("map_insert"), count("local_bundle_adjustment")};
  }
  // What the mapper has done since it was stopped.
  Work Done() const {
    AwaitMapper();
    const Work now = CountWork();
    return {now.keyframes - before_.keyframes, now.adjustments - before_.adjustments};
  }

 private:
  const SyntheticWorld world_ = NoisyWorld();
  const SystemOptions options_;
  const std::unique_ptr<Pipeline> pipeline_ =
      MakeThreadedPipeline(world_.sensor(), options_, Pace::kNeverWait);
  uint32_t next_ = 0;
  Work before_;
};

TEST_F(HurryOfTheMapper, IsThereWhileAKeyframeWaits) {
  {
    const ClosedGate gate;
    BeginKeyframe();
    TrackOn();
  }
  const Work done = Done();
  EXPECT_GT(done.keyframes, 1U) << "no second keyframe was requested";
  EXPECT_EQ(done.adjustments, 1U) << "only after the last of them there is time";
}

TEST_F(HurryOfTheMapper, IsNotThereWhileOnlyLateDetectionsWait) {
  {
    const ClosedGate gate;
    BeginKeyframe();
    AddLate(5);
  }
  EXPECT_EQ(Done(), (Work{.keyframes = 1, .adjustments = 1}));
}

TEST_F(HurryOfTheMapper, EndsWithTheLastKeyframeAlthoughLateDetectionsWait) {
  {
    const ClosedGate gate;
    BeginKeyframe();
    AddLate(2);
    TrackOn();
    AddLate(2);
  }
  const Work done = Done();
  EXPECT_GT(done.keyframes, 1U) << "no second keyframe was requested";
  EXPECT_EQ(done.adjustments, 1U);
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
[[gnu::noinline]] void* operator new(size_t size) { return hullslam::Allocate(size); }
[[gnu::noinline]] void* operator new(size_t size, const std::nothrow_t& /*tag*/) noexcept {
  return std::malloc(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, size_t /*size*/) noexcept {
  std::free(memory);
}
