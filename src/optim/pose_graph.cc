// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/pose_graph.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <cmath>

#include "costs/manifolds.h"
#include "costs/relative_similarity.h"
#include "hullslam/util/check.h"
#include "optim/supervision.h"

namespace hullslam {
namespace {

bool IsFinite(const Sim3& similarity) {
  return std::isfinite(similarity.scale) && similarity.scale > 0.0 &&
         similarity.rotation.coeffs().allFinite() && similarity.translation.allFinite();
}

bool IsFinite(const PoseGraph& graph) {
  for (const PoseGraph::Node& node : graph.nodes) {
    if (!IsFinite(node.cam_from_world)) {
      return false;
    }
  }
  for (const PoseGraph::Edge& edge : graph.edges) {
    if (!IsFinite(edge.b_from_a) || !edge.inverse_sigma.allFinite()) {
      return false;
    }
  }
  return true;
}

void AddEdges(const PoseGraph& graph, std::vector<SimilarityBlock>& blocks,
              ceres::Problem& problem) {
  for (const PoseGraph::Edge& edge : graph.edges) {
    Check(edge.a < blocks.size() && edge.b < blocks.size() && edge.a != edge.b,
          "an edge of the pose graph must connect two different nodes");
    problem.AddResidualBlock(new RelativeSimilarityCost(edge.b_from_a, edge.inverse_sigma), nullptr,
                             blocks[edge.a].data(), blocks[edge.b].data());
  }
}

}  // namespace

PoseGraphResult OptimizePoseGraph(const PoseGraph& graph, const PoseGraphOptions& options,
                                  const Cancellation* cancellation,
                                  const ProgressCallback& on_progress) {
  PoseGraphResult result;
  std::vector<SimilarityBlock> blocks;
  for (const PoseGraph::Node& node : graph.nodes) {
    result.cam_from_world.push_back(node.cam_from_world);
    blocks.push_back(ToBlock(node.cam_from_world));
  }
  SimilarityManifold manifold(options.fix_scale);
  ceres::Problem::Options problem_options;
  problem_options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  AddEdges(graph, blocks, problem);
  if (!IsFinite(graph)) {
    return result;
  }
  for (size_t i = 0; i < blocks.size(); ++i) {
    if (problem.HasParameterBlock(blocks[i].data())) {
      problem.SetManifold(blocks[i].data(), &manifold);
      if (graph.nodes[i].is_fixed) {
        problem.SetParameterBlockConstant(blocks[i].data());
      }
    }
  }
  internal::Supervision supervision(cancellation, on_progress, options.max_iterations);
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = options.function_tolerance;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  solver.callbacks.push_back(&supervision);
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  result.is_usable = summary.IsSolutionUsable();
  result.is_cancelled = summary.termination_type == ceres::USER_SUCCESS;
  result.iterations = static_cast<int>(summary.iterations.size()) - 1;  // without the start
  result.initial_cost = summary.initial_cost;
  result.final_cost = summary.final_cost;
  for (size_t i = 0; result.is_usable && i < blocks.size(); ++i) {
    result.cam_from_world[i] = SimilarityFromBlock(blocks[i].data());
  }
  return result;
}

}  // namespace hullslam
