// SPDX-License-Identifier: GPL-3.0-or-later
// The cost of the messages of the live view in small and large maps, and how many bytes they have.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>

#include "live/live_messages.h"
#include "made_map.h"

namespace hullslam {
namespace {

struct Watched {
  explicit Watched(benchmark::State& state)
      : map(MakeBenchMap(static_cast<uint32_t>(state.range(0)), BenchSensor())),
        messages(Describe(), {}) {
    Publish();
    messages.MapChange(now, false);
  }

  static LiveRun Describe() {
    LiveRun run;
    run.sensor = BenchSensor();
    return run;
  }

  void Publish() { now.map = std::make_shared<const Map>(map.Snapshot()); }

  // Moves the landmarks that the last 20 keyframes see, as local bundle adjustment does.
  void Adjust() {
    const uint32_t end = map.keyframes().NextId().value;
    std::vector<LandmarkId> moved;
    map.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
      if (!landmark.observations.empty() &&
          landmark.observations.back().keyframe.value + 20 >= end) {
        moved.push_back(id);
      }
    });
    for (const LandmarkId id : moved) {
      map.SetPosition(id, map.landmarks().At(id).position + Eigen::Vector3d(0.0, 0.0, step));
    }
    step = -step;
    Publish();
  }

  Map map;
  LiveState now;
  LiveMessages messages;
  double step = 0.05;  // m
};

void Count(benchmark::State& state, const Watched& watched, size_t bytes) {
  state.counters["landmarks"] = static_cast<double>(watched.map.landmarks().size());
  state.counters["bytes"] = static_cast<double>(bytes);
}

void WholeMessage(benchmark::State& state) {
  const Watched watched(state);
  size_t bytes = 0;
  for (auto _ : state) {
    bytes = watched.messages.Whole({}).size();
  }
  Count(state, watched, bytes);
}
BENCHMARK(WholeMessage)
    ->ArgName("keyframes")
    ->Arg(30)
    ->Arg(1000)
    ->Arg(10000)
    ->Unit(benchmark::kMillisecond);

void ChangeAfterAdjustment(benchmark::State& state) {
  Watched watched(state);
  size_t bytes = 0;
  for (auto _ : state) {
    state.PauseTiming();
    watched.Adjust();
    state.ResumeTiming();
    bytes = watched.messages.MapChange(watched.now, true).value_or("").size();
  }
  Count(state, watched, bytes);
}
BENCHMARK(ChangeAfterAdjustment)
    ->ArgName("keyframes")
    ->Arg(30)
    ->Arg(1000)
    ->Arg(10000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hullslam

BENCHMARK_MAIN();
