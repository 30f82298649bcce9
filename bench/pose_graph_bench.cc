// SPDX-License-Identifier: GPL-3.0-or-later
// Closes a loop in an essential graph: a path of many rounds whose poses drift, with an edge to the
// keyframe before, edges to three keyframes of strong covisibility, and one loop edge.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "optim/pose_graph.h"

namespace hullslam {
namespace {

// On a spiral with 100 keyframes per round.
Sim3 TruePose(size_t index) {
  const double angle = 2.0 * std::numbers::pi * static_cast<double>(index) / 100.0;
  const double radius = 5.0 + 1e-3 * static_cast<double>(index);
  const Rigid3 world_from_cam(ExpSo3({0.0, std::remainder(angle, 2.0 * std::numbers::pi), 0.0}),
                              {radius * std::cos(angle), 0.0, -radius * std::sin(angle)});
  return Sim3(Inverse(world_from_cam));
}

PoseGraph MakeGraph(size_t count, bool has_scale) {
  std::mt19937 random(1);
  const auto number = [&random](double reach) {
    return std::uniform_real_distribution<double>(-reach, reach)(random);
  };
  PoseGraph graph;
  graph.nodes.push_back({TruePose(0), true});
  for (size_t i = 1; i < count; ++i) {
    const double size = 2.0 / static_cast<double>(count);
    const Eigen::Vector3d omega(size * number(1.0), size * (0.2 + number(1.0)), size * number(1.0));
    const Eigen::Vector3d step(size * (1.0 + number(1.0)), size * number(1.0), size * number(1.0));
    const Sim3 drift(has_scale ? std::exp(0.2 * size * (1.0 + number(1.0))) : 1.0, ExpSo3(omega),
                     step);
    const Sim3 measured = drift * TruePose(i) * Inverse(TruePose(i - 1));
    graph.nodes.push_back({measured * graph.nodes.back().cam_from_world, false});
  }
  for (size_t i = 1; i < count; ++i) {
    for (const size_t back : {1, 2, 3, 5}) {
      if (i >= back) {
        PoseGraph::Edge& edge = graph.edges.emplace_back();
        edge.a = i - back;
        edge.b = i;
        edge.b_from_a =
            graph.nodes[i].cam_from_world * Inverse(graph.nodes[i - back].cam_from_world);
      }
    }
  }
  PoseGraph::Edge& loop = graph.edges.emplace_back();
  loop.a = count - 1;
  loop.b = 0;
  loop.b_from_a = TruePose(0) * Inverse(TruePose(count - 1));
  loop.inverse_sigma.setConstant(10.0);
  return graph;
}

void PoseGraphOptimization(benchmark::State& state) {
  const bool fix_scale = state.range(1) != 0;
  const PoseGraph graph = MakeGraph(static_cast<size_t>(state.range(0)), !fix_scale);
  PoseGraphResult result;
  for (auto _ : state) {
    result = OptimizePoseGraph(graph, {.fix_scale = fix_scale});
  }
  state.counters["edges"] = static_cast<double>(graph.edges.size());
  state.counters["iterations"] = result.iterations;
  state.counters["cost_share"] = result.final_cost / result.initial_cost;
}
BENCHMARK(PoseGraphOptimization)
    ->ArgNames({"nodes", "fix_scale"})
    ->ArgsProduct({{1000, 10000}, {1, 0}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hullslam

BENCHMARK_MAIN();
