// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/assignment.h"

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/maximum_weighted_matching.hpp>
#include <cmath>
#include <cstdint>

#include "hullslam/util/check.h"

namespace hullslam {

// The rows and the columns are the vertices of a graph. The weight of a pair is what its choice
// saves, so the matching with the largest weight costs least.
std::vector<int> AssignMinimumCost(const Eigen::MatrixXd& cost, double max_cost) {
  Check(std::isfinite(max_cost), "the cost of leaving a row out is not finite");
  using Graph =
      boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, boost::no_property,
                            boost::property<boost::edge_weight_t, int64_t>>;
  constexpr double kUnits = 0x1p40;  // the algorithm is exact for even integers only
  const auto rows = static_cast<size_t>(cost.rows());
  Graph graph(rows + static_cast<size_t>(cost.cols()));
  for (Eigen::Index row = 0; row < cost.rows(); ++row) {
    for (Eigen::Index column = 0; column < cost.cols(); ++column) {
      if (cost(row, column) < max_cost) {
        boost::add_edge(static_cast<size_t>(row), rows + static_cast<size_t>(column),
                        2 * std::llround(kUnits * (max_cost - cost(row, column))), graph);
      }
    }
  }
  std::vector<Graph::vertex_descriptor> partner(boost::num_vertices(graph), Graph::null_vertex());
  if (boost::num_edges(graph) > 0) {  // without edges, Boost 1.74 has an overflow
    boost::maximum_weighted_matching(graph, partner.data());
  }
  std::vector<int> column_of(rows, -1);
  for (size_t row = 0; row < rows; ++row) {
    if (partner[row] != Graph::null_vertex()) {
      column_of[row] = static_cast<int>(partner[row] - rows);
    }
  }
  return column_of;
}

}  // namespace hullslam
