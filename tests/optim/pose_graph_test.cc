// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/pose_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "hullslam/util/check.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

// Cameras on a circle of 5 m radius that look along it.
std::vector<Sim3> Circle(size_t count) {
  std::vector<Sim3> poses;
  for (size_t i = 0; i < count; ++i) {
    const double angle =
        2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    const Rigid3 world_from_cam(ExpSo3({0.0, angle, 0.0}),
                                {5.0 * std::cos(angle), 0.0, -5.0 * std::sin(angle)});
    poses.emplace_back(Inverse(world_from_cam));
  }
  return poses;
}

// The drift from one keyframe to the next: 0.2 degrees about the vertical axis, 5 mm downwards, 0.2
// % of scale, and some noise. There is no drift along the path, because one loop edge could not
// correct it: the circle would only become larger.
Sim3 DriftStep(RandomGeometry& random, bool has_scale) {
  const Eigen::Vector3d omega = Eigen::Vector3d(0.0, 4e-3, 0.0) + random.Vector(1e-3);
  const Eigen::Vector3d step = Eigen::Vector3d(0.0, 5e-3, 0.0) + random.Vector(3e-3);
  return {has_scale ? std::exp(2e-3 + random.Number(-5e-4, 5e-4)) : 1.0, ExpSo3(omega), step};
}

// 1 / the size of the drift of a step.
Eigen::Matrix<double, 7, 1> InverseSigma() {
  Eigen::Matrix<double, 7, 1> sigma;
  sigma << 4e-3, 4e-3, 4e-3, 1e-2, 1e-2, 1e-2, 2e-3;
  return sigma.cwiseInverse();
}

// A chain with drift that starts at the first true pose, which is fixed, and one loop edge without
// error from the last to the first.
PoseGraph DriftedLoop(const std::vector<Sim3>& truth, bool has_scale) {
  RandomGeometry random(1);
  PoseGraph graph;
  graph.nodes.push_back({truth[0], true});
  for (size_t i = 1; i < truth.size(); ++i) {
    const Sim3 measured = DriftStep(random, has_scale) * truth[i] * Inverse(truth[i - 1]);
    graph.nodes.push_back({measured * graph.nodes.back().cam_from_world, false});
    PoseGraph::Edge edge{.a = i - 1, .b = i, .b_from_a = measured};
    edge.inverse_sigma = InverseSigma();
    graph.edges.push_back(edge);
  }
  PoseGraph::Edge loop{.a = truth.size() - 1, .b = 0, .b_from_a = truth[0] * Inverse(truth.back())};
  loop.inverse_sigma = 10.0 * InverseSigma();
  graph.edges.push_back(loop);
  return graph;
}

Eigen::Vector3d Center(const Sim3& cam_from_world) { return Inverse(cam_from_world).translation; }

double RmsError(const std::vector<Sim3>& poses, const std::vector<Sim3>& truth) {
  double sum = 0.0;
  for (size_t i = 0; i < poses.size(); ++i) {
    sum += (Center(poses[i]) - Center(truth[i])).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(poses.size()));
}

std::vector<Sim3> PosesOf(const PoseGraph& graph) {
  std::vector<Sim3> poses;
  for (const PoseGraph::Node& node : graph.nodes) {
    poses.push_back(node.cam_from_world);
  }
  return poses;
}

void ExpectSameBits(const Sim3& a, const Sim3& b) {
  EXPECT_EQ(a.scale, b.scale);
  EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs());
  EXPECT_EQ(a.translation, b.translation);
}

TEST(PoseGraph, ALoopEdgeRemovesTheDriftOfACircle) {
  const std::vector<Sim3> truth = Circle(200);
  const PoseGraph graph = DriftedLoop(truth, false);
  const PoseGraphResult result = OptimizePoseGraph(graph, {.fix_scale = true});
  ASSERT_TRUE(result.is_usable);
  const double before = RmsError(PosesOf(graph), truth);
  EXPECT_GT(before, 1.0);
  EXPECT_LT(RmsError(result.cam_from_world, truth), 0.1 * before);
  EXPECT_LT(result.final_cost, 0.01 * result.initial_cost);
  EXPECT_GT(result.iterations, 1);
  for (const Sim3& pose : result.cam_from_world) {
    EXPECT_EQ(pose.scale, 1.0);
    EXPECT_NEAR(pose.rotation.norm(), 1.0, 1e-12);
  }
}

TEST(PoseGraph, ALoopEdgeRemovesTheDriftOfTheScale) {
  const std::vector<Sim3> truth = Circle(200);
  const PoseGraph graph = DriftedLoop(truth, true);
  const PoseGraphResult result = OptimizePoseGraph(graph, {});
  ASSERT_TRUE(result.is_usable);
  const double before = RmsError(PosesOf(graph), truth);
  EXPECT_GT(graph.nodes.back().cam_from_world.scale, 1.4);
  EXPECT_NEAR(result.cam_from_world.back().scale, 1.0, 0.01);
  EXPECT_LT(RmsError(result.cam_from_world, truth), 0.1 * before);
  // Without the scale the loop cannot be closed as well.
  const PoseGraphResult rigid = OptimizePoseGraph(graph, {.fix_scale = true});
  EXPECT_GT(RmsError(rigid.cam_from_world, truth), RmsError(result.cam_from_world, truth));
}

// A node with one edge moves to the pose that the edge gives. A node with two edges that disagree
// moves to their weighted mean.
TEST(PoseGraph, ByHand) {
  PoseGraph graph;
  graph.nodes = {{Sim3(), true}, {Sim3(), false}};
  PoseGraph::Edge edge{.a = 0, .b = 1};
  edge.b_from_a = Sim3(1.0, Eigen::Quaterniond::Identity(), {1.0, 0.0, 0.0});
  graph.edges.push_back(edge);
  PoseGraphResult result =
      OptimizePoseGraph(graph, {.fix_scale = true, .function_tolerance = 1e-14});
  EXPECT_DOUBLE_EQ(result.initial_cost, 0.5);
  EXPECT_NEAR(result.cam_from_world[1].translation.x(), 1.0, 1e-6);
  edge.b_from_a.translation.x() = 4.0;
  edge.inverse_sigma.setConstant(std::sqrt(2.0));
  graph.edges.push_back(edge);
  result = OptimizePoseGraph(graph, {.fix_scale = true, .function_tolerance = 1e-14});
  // (1 * 1 + 2 * 4) / 3, and half of (2^2 + 2 * 1^2).
  EXPECT_NEAR(result.cam_from_world[1].translation.x(), 3.0, 1e-5);
  EXPECT_NEAR(result.final_cost, 3.0, 1e-5);
}

TEST(PoseGraph, NothingMovesIfAllEdgesAgree) {
  const std::vector<Sim3> truth = Circle(50);
  for (const bool fix_scale : {false, true}) {
    PoseGraph graph;
    for (size_t i = 0; i < truth.size(); ++i) {
      graph.nodes.push_back({truth[i], i == 0});
      const size_t next = (i + 1) % truth.size();
      graph.edges.push_back({.a = i, .b = next, .b_from_a = truth[next] * Inverse(truth[i])});
    }
    const PoseGraphResult result = OptimizePoseGraph(graph, {.fix_scale = fix_scale});
    ASSERT_TRUE(result.is_usable);
    for (size_t i = 0; i < truth.size(); ++i) {
      ExpectSameBits(result.cam_from_world[i], truth[i]);
    }
  }
}

TEST(PoseGraph, FixedNodesAndNodesWithoutEdgesStay) {
  const std::vector<Sim3> truth = Circle(40);
  PoseGraph graph = DriftedLoop(truth, true);
  graph.nodes[20].is_fixed = true;
  graph.nodes.push_back({Sim3(7.0, ExpSo3({1.0, 2.0, 3.0}), {4.0, 5.0, 6.0}), false});
  const PoseGraphResult result = OptimizePoseGraph(graph, {});
  ASSERT_TRUE(result.is_usable);
  ASSERT_EQ(result.cam_from_world.size(), 41u);
  for (const size_t i : {0u, 20u, 40u}) {
    ExpectSameBits(result.cam_from_world[i], graph.nodes[i].cam_from_world);
  }
  EXPECT_NE(result.cam_from_world[10].translation, graph.nodes[10].cam_from_world.translation);
  // With all nodes fixed there is nothing to do.
  for (PoseGraph::Node& node : graph.nodes) {
    node.is_fixed = true;
  }
  const PoseGraphResult fixed = OptimizePoseGraph(graph, {});
  EXPECT_TRUE(fixed.is_usable);
  ExpectSameBits(fixed.cam_from_world[10], graph.nodes[10].cam_from_world);
}

TEST(PoseGraph, DoesNotDependOnTheWorldFrame) {
  const std::vector<Sim3> truth = Circle(60);
  const PoseGraph graph = DriftedLoop(truth, true);
  const Sim3 old_from_new(2.0, ExpSo3({0.5, -1.0, 2.0}), {3.0, -4.0, 5.0});
  PoseGraph moved = graph;
  for (PoseGraph::Node& node : moved.nodes) {
    node.cam_from_world = node.cam_from_world * old_from_new;
  }
  const PoseGraphResult expected = OptimizePoseGraph(graph, {.function_tolerance = 1e-12});
  const PoseGraphResult found = OptimizePoseGraph(moved, {.function_tolerance = 1e-12});
  for (size_t i = 0; i < truth.size(); ++i) {
    const Sim3 back = found.cam_from_world[i] * Inverse(old_from_new);
    EXPECT_LT((back.translation - expected.cam_from_world[i].translation).norm(), 1e-4);
    EXPECT_NEAR(back.scale, expected.cam_from_world[i].scale, 1e-5);
  }
}

TEST(PoseGraph, SameInputGivesTheSameBits) {
  const PoseGraph graph = DriftedLoop(Circle(100), true);
  const PoseGraphResult first = OptimizePoseGraph(graph, {});
  const PoseGraphResult second = OptimizePoseGraph(graph, {});
  EXPECT_EQ(first.final_cost, second.final_cost);
  EXPECT_EQ(first.iterations, second.iterations);
  for (size_t i = 0; i < graph.nodes.size(); ++i) {
    ExpectSameBits(first.cam_from_world[i], second.cam_from_world[i]);
  }
}

TEST(PoseGraph, ACancelledOptimisationEndsEarly) {
  const PoseGraph graph = DriftedLoop(Circle(100), false);
  Cancellation cancellation;
  int calls = 0;
  const PoseGraphResult result =
      OptimizePoseGraph(graph, {.fix_scale = true}, &cancellation, [&](int done, int most) {
        EXPECT_EQ(done, ++calls);
        EXPECT_EQ(most, 50);
        cancellation.Request();
      });
  EXPECT_TRUE(result.is_usable);
  EXPECT_TRUE(result.is_cancelled);
  EXPECT_EQ(result.iterations, 1);
  EXPECT_EQ(calls, 1);
  EXPECT_FALSE(OptimizePoseGraph(graph, {.fix_scale = true}).is_cancelled);
}

TEST(PoseGraph, NumbersThatAreNotFiniteGiveNoResult) {
  const PoseGraph graph = DriftedLoop(Circle(10), false);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<PoseGraph> broken(5, graph);
  broken[0].nodes[3].cam_from_world.translation.x() = nan;
  broken[1].nodes[3].cam_from_world.scale = 0.0;
  broken[2].edges[3].b_from_a.rotation.w() = nan;
  broken[3].edges[3].inverse_sigma[2] = std::numeric_limits<double>::infinity();
  broken[4].edges[3].b_from_a.scale = -1.0;
  for (const PoseGraph& one : broken) {
    const PoseGraphResult result = OptimizePoseGraph(one, {});
    EXPECT_FALSE(result.is_usable);
    ExpectSameBits(result.cam_from_world[5], one.nodes[5].cam_from_world);
  }
}

TEST(PoseGraph, EmptyGraphsAndWrongEdges) {
  EXPECT_TRUE(OptimizePoseGraph({}, {}).cam_from_world.empty());
  PoseGraph graph;
  graph.nodes.resize(2);
  graph.edges = {{.a = 0, .b = 2}};
  EXPECT_THROW(OptimizePoseGraph(graph, {}), CheckError);
  graph.edges = {{.a = 1, .b = 1}};
  EXPECT_THROW(OptimizePoseGraph(graph, {}), CheckError);
}

}  // namespace
}  // namespace hullslam
