// SPDX-License-Identifier: GPL-3.0-or-later
// Local bundle adjustment around the newest keyframe of a synthetic map, with as many keyframes as
// mapping uses by default, and with fewer. Each problem is also solved with the sparse system of a
// large map (sparse:1).
#include <benchmark/benchmark.h>

#include "hullslam/mapping/mapping_options.h"
#include "made_map.h"
#include "optim/bundle_adjustment.h"

namespace hullslam {
namespace {

BundleOptions Solver(const benchmark::State& state) {
  BundleOptions options;
  if (state.range(1) != 0) {
    options.max_dense = 0;
  }
  return options;
}

void LocalBundleAdjustment(benchmark::State& state) {
  const Sensor sensor = BenchSensor();
  const Map map = MakeBenchMap(60, sensor);
  const BundleWindow window = LocalWindow(map, KeyframeId(59), static_cast<size_t>(state.range(0)),
                                          static_cast<size_t>(MappingOptions().fixed_keyframes));
  BundleResult result;
  for (auto _ : state) {
    result = AdjustBundle(map, sensor, window, Solver(state), nullptr);
  }
  state.counters["moving"] = static_cast<double>(window.moving.size());
  state.counters["fixed"] = static_cast<double>(window.fixed.size());
  state.counters["landmarks"] = static_cast<double>(window.landmarks.size());
  state.counters["residuals"] = result.residuals;
  state.counters["iterations"] = result.iterations;
}
BENCHMARK(LocalBundleAdjustment)
    ->ArgNames({"max_moving", "sparse"})
    ->ArgsProduct({{5, MappingOptions().local_keyframes}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

// The same with objects, of which each image shows about range(0).
void ObjectBundleAdjustment(benchmark::State& state) {
  const Sensor sensor = BenchSensor();
  const double spacing = 2.0 / static_cast<double>(state.range(0));
  const Map map = MakeBenchMap(60, sensor, BenchObjects(60, spacing));
  const MappingOptions options;
  const BundleWindow window =
      LocalWindow(map, KeyframeId(59), static_cast<size_t>(options.local_keyframes),
                  static_cast<size_t>(options.fixed_keyframes), WindowObjects::kMapped);
  BundleResult result;
  for (auto _ : state) {
    result = AdjustBundle(map, sensor, window, Solver(state), nullptr);
  }
  state.counters["objects"] = static_cast<double>(window.objects.size());
  state.counters["residuals"] = result.residuals;
  state.counters["iterations"] = result.iterations;
}
BENCHMARK(ObjectBundleAdjustment)
    ->ArgNames({"in_view", "sparse"})
    ->ArgsProduct({{4, 10}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

void Window(benchmark::State& state) {
  const Map map = MakeBenchMap(60, BenchSensor());
  for (auto _ : state) {
    benchmark::DoNotOptimize(LocalWindow(map, KeyframeId(59),
                                         static_cast<size_t>(MappingOptions().local_keyframes),
                                         static_cast<size_t>(MappingOptions().fixed_keyframes)));
  }
}
BENCHMARK(Window)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hullslam

BENCHMARK_MAIN();
