// SPDX-License-Identifier: GPL-3.0-or-later
// The cost of publishing the map: of the copy itself, and of the writes after it, which clone the
// chunks that the snapshot shares.
#include <benchmark/benchmark.h>

#include <vector>

#include "made_map.h"

namespace hullslam {
namespace {

void Count(benchmark::State& state, const Map& map) {
  state.counters["keyframes"] = static_cast<double>(map.keyframes().size());
  state.counters["landmarks"] = static_cast<double>(map.landmarks().size());
}

void SnapshotCopy(benchmark::State& state) {
  Map map = MakeBenchMap(static_cast<uint32_t>(state.range(0)), BenchSensor());
  for (auto _ : state) {
    benchmark::DoNotOptimize(map.Snapshot());
  }
  Count(state, map);
}
BENCHMARK(SnapshotCopy)->ArgName("keyframes")->Arg(30)->Arg(300)->Unit(benchmark::kMicrosecond);

// Writes to all landmarks that one of the last 20 keyframes sees, as local bundle adjustment does.
void WriteAfterSnapshot(benchmark::State& state) {
  Map map = MakeBenchMap(static_cast<uint32_t>(state.range(0)), BenchSensor());
  std::vector<LandmarkId> written;
  const uint32_t end = map.keyframes().NextId().value;
  map.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    if (!landmark.observations.empty() && landmark.observations.back().keyframe.value + 20 >= end) {
      written.push_back(id);
    }
  });
  for (auto _ : state) {
    const Map snapshot = map.Snapshot();
    for (const LandmarkId id : written) {
      map.CountSightings(id, 1, 1);
    }
    benchmark::DoNotOptimize(snapshot);
  }
  Count(state, map);
  state.counters["written"] = static_cast<double>(written.size());
}
BENCHMARK(WriteAfterSnapshot)
    ->ArgName("keyframes")
    ->Arg(30)
    ->Arg(300)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hullslam

BENCHMARK_MAIN();
