// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Core>
#include <limits>

#include "segmentation/network_layout.h"

namespace hullslam {
namespace {

// The channels of one cell: a column of the map, whose rows are the channels.
using Channels = Eigen::Map<const Eigen::VectorXf, Eigen::Unaligned, Eigen::InnerStride<>>;

double MeanDistance(const Eigen::VectorXf& logits) {
  const Eigen::ArrayXd weights = (logits.array() - logits.maxCoeff()).cast<double>().exp();
  const Eigen::ArrayXd distances = Eigen::ArrayXd::LinSpaced(kDistances, 0.0, kDistances - 1.0);
  return (weights * distances).sum() / weights.sum();
}

Candidate MakeCandidate(const Channels& cell, const Eigen::Array2d& centre, double stride,
                        double score, int class_number, int coefficients) {
  std::array<double, 4> sides{};
  for (int side = 0; side < 4; ++side) {
    sides.at(static_cast<size_t>(side)) =
        stride * MeanDistance(cell.segment(side * kDistances, kDistances));
  }
  return {.least = centre - Eigen::Array2d(sides[0], sides[1]),
          .greatest = centre + Eigen::Array2d(sides[2], sides[3]),
          .score = score,
          .class_number = class_number,
          .coefficients = cell.tail(coefficients)};
}

// The largest class logit of each cell, and its class. Reads the map in the order of its memory.
struct BestClasses {
  Eigen::ArrayXf logits;
  Eigen::ArrayXi numbers;
};

BestClasses FindBestClasses(const cv::Mat& map, int class_count) {
  const Eigen::Index cells = Eigen::Index{map.size[2]} * map.size[3];
  BestClasses best{Eigen::ArrayXf::Constant(cells, -std::numeric_limits<float>::infinity()),
                   Eigen::ArrayXi::Zero(cells)};
  for (int number = 0; number < class_count; ++number) {
    const float* const logits = map.ptr<float>(0, kBoxChannels + number);
    for (Eigen::Index cell = 0; cell < cells; ++cell) {
      if (logits[cell] > best.logits[cell]) {
        best.logits[cell] = logits[cell];
        best.numbers[cell] = number;
      }
    }
  }
  return best;
}

}  // namespace

std::vector<Candidate> DecodeCells(const NetworkLayout& layout,
                                   std::span<const NetworkOutput> outputs,
                                   const CandidateFilter& filter) {
  std::vector<Candidate> candidates;
  for (const size_t head : layout.heads) {
    const cv::Mat& map = outputs[head].values;
    const int columns = map.size[3];
    const Eigen::Index cells = Eigen::Index{map.size[2]} * columns;
    const double stride = static_cast<double>(layout.input.width) / columns;
    const BestClasses best = FindBestClasses(map, layout.class_count);
    for (Eigen::Index i = 0; i < cells; ++i) {
      const double score = Sigmoid(best.logits[i]);
      if (filter.Accepts(score, best.numbers[i])) {
        const Channels cell(map.ptr<float>() + i, map.size[1], Eigen::InnerStride<>(cells));
        const Eigen::Array2d centre(static_cast<double>(i % columns) + 0.5,
                                    static_cast<double>(i / columns) + 0.5);
        candidates.push_back(MakeCandidate(cell, stride * centre, stride, score, best.numbers[i],
                                           layout.coefficient_count));
      }
    }
  }
  return candidates;
}

}  // namespace hullslam
