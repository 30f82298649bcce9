// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Core>

#include "segmentation/network_layout.h"

namespace hullslam {
namespace {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::Map<const Matrix> MatrixOf(const cv::Mat& values) {
  return {values.ptr<float>(), values.size[1], values.size[2]};
}

// Adds the candidate of a row if the filter accepts it. `objectness` is the factor of its scores.
void AddRow(const Eigen::VectorXf& row, Eigen::Index first_class, double objectness,
            const NetworkLayout& layout, const CandidateFilter& filter,
            std::vector<Candidate>& candidates) {
  Eigen::Index best = 0;
  const double score = objectness * row.segment(first_class, layout.class_count).maxCoeff(&best);
  if (!filter.Accepts(score, static_cast<int>(best))) {
    return;
  }
  const Eigen::Array2d centre = row.head<2>().cast<double>();
  const Eigen::Array2d half = 0.5 * row.segment<2>(2).cast<double>();
  candidates.push_back({.least = centre - half,
                        .greatest = centre + half,
                        .score = score,
                        .class_number = static_cast<int>(best),
                        .coefficients = row.tail(layout.coefficient_count)});
}

}  // namespace

std::vector<Candidate> DecodeColumns(const NetworkLayout& layout,
                                     std::span<const NetworkOutput> outputs,
                                     const CandidateFilter& filter) {
  const auto matrix = MatrixOf(outputs[layout.heads.front()].values);
  const Eigen::RowVectorXf best = matrix.middleRows(4, layout.class_count).colwise().maxCoeff();
  std::vector<Candidate> candidates;
  for (Eigen::Index i = 0; i < matrix.cols(); ++i) {
    if (best[i] >= filter.min_score) {
      AddRow(matrix.col(i), 4, 1.0, layout, filter, candidates);
    }
  }
  return candidates;
}

std::vector<Candidate> DecodeRows(const NetworkLayout& layout,
                                  std::span<const NetworkOutput> outputs,
                                  const CandidateFilter& filter) {
  const auto matrix = MatrixOf(outputs[layout.heads.front()].values);
  std::vector<Candidate> candidates;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    const double objectness = matrix(i, 4);
    if (objectness >= filter.min_score) {  // no score of a class is above 1
      AddRow(matrix.row(i), 5, objectness, layout, filter, candidates);
    }
  }
  return candidates;
}

}  // namespace hullslam
