// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "hullslam/geometry/sim3.h"
#include "hullslam/util/cancellation.h"

namespace hullslam {

// Keyframes and measured similarities between them, like the essential graph of ORB-SLAM.
struct PoseGraph {
  struct Node {
    Sim3 cam_from_world;
    bool is_fixed = false;
  };
  struct Edge {
    size_t a = 0;  // indices of nodes
    size_t b = 0;
    Sim3 b_from_a = {};  // between the camera frames
    // 1 / standard deviation of rotation (3 values, radians), translation (3, in b's unit of
    // length) and logarithm of the scale.
    Eigen::Matrix<double, 7, 1> inverse_sigma = Eigen::Matrix<double, 7, 1>::Ones();
  };

  std::vector<Node> nodes;
  std::vector<Edge> edges;
};

struct PoseGraphOptions {
  bool fix_scale = false;  // nodes keep their scales to the last bit, as in RGB-D
  int max_iterations = 50;
  double function_tolerance =
      1e-6;  // a step with a smaller relative decrease of the cost is the last
};

struct PoseGraphResult {
  std::vector<Sim3> cam_from_world;  // one per node; as in the graph if it is not usable
  bool is_usable = false;            // false if a number is not finite or the solver failed
  bool is_cancelled = false;         // it ended early; the result is usable but not the optimum
  int iterations = 0;
  double initial_cost = 0.0;  // half the sum of the squared residuals of RelativeSimilarityCost
  double final_cost = 0.0;
};

// The poses that agree best with all edges. Fixed nodes and nodes without an edge do not change by
// a single bit, and neither does any node if the edges agree already. At least one node of every
// connected part should be fixed, because the edges do not determine the pose of a part as a whole.
// If `cancellation` (may be null) is requested, the optimisation ends early. `on_progress` is
// called after each iteration. It runs in one thread, so the same input gives the same bits. Throws
// CheckError if an edge does not connect two different nodes of the graph.
PoseGraphResult OptimizePoseGraph(const PoseGraph& graph, const PoseGraphOptions& options,
                                  const Cancellation* cancellation = nullptr,
                                  const ProgressCallback& on_progress = {});

}  // namespace hullslam
