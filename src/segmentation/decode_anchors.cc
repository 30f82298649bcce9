// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Core>
#include <array>

#include "segmentation/network_layout.h"

namespace hullslam {
namespace {

// Width and height of the anchors for the strides 8, 16 and 32, px.
constexpr std::array<std::array<std::array<double, 2>, kAnchorsPerCell>, 3> kAnchors = {
    {{{{10, 13}, {16, 30}, {33, 23}}},
     {{{30, 61}, {62, 45}, {59, 119}}},
     {{{116, 90}, {156, 198}, {373, 326}}}}};

// The channels of one anchor in one cell.
using Channels = Eigen::Map<const Eigen::VectorXf, Eigen::Unaligned, Eigen::InnerStride<>>;

void AddAnchor(const Channels& channels, const Eigen::Array2d& corner, double stride,
               const std::array<double, 2>& anchor, const NetworkLayout& layout,
               const CandidateFilter& filter, std::vector<Candidate>& candidates) {
  const double objectness = Sigmoid(channels[4]);
  if (objectness < filter.min_score) {  // no score of a class is above 1
    return;
  }
  Eigen::Index best = 0;
  const double score =
      objectness * Sigmoid(channels.segment(5, layout.class_count).maxCoeff(&best));
  if (!filter.Accepts(score, static_cast<int>(best))) {
    return;
  }
  const Eigen::Array2d centre =
      stride * (corner + 2.0 * Eigen::Array2d(Sigmoid(channels[0]), Sigmoid(channels[1])) - 0.5);
  const Eigen::Array2d size =
      (2.0 * Eigen::Array2d(Sigmoid(channels[2]), Sigmoid(channels[3]))).square() *
      Eigen::Array2d(anchor[0], anchor[1]);
  candidates.push_back({.least = centre - 0.5 * size,
                        .greatest = centre + 0.5 * size,
                        .score = score,
                        .class_number = static_cast<int>(best),
                        .coefficients = channels.tail(layout.coefficient_count)});
}

}  // namespace

std::vector<Candidate> DecodeAnchors(const NetworkLayout& layout,
                                     std::span<const NetworkOutput> outputs,
                                     const CandidateFilter& filter) {
  const int channel_count = 5 + layout.class_count + layout.coefficient_count;
  std::vector<Candidate> candidates;
  for (size_t level = 0; level < layout.heads.size(); ++level) {
    const cv::Mat& map = outputs[layout.heads[level]].values;
    const int columns = map.size[3];
    const Eigen::Index cells = Eigen::Index{map.size[2]} * columns;
    const double stride = static_cast<double>(layout.input.width) / columns;
    for (int anchor = 0; anchor < kAnchorsPerCell; ++anchor) {
      const float* const first = map.ptr<float>(0, anchor * channel_count);
      for (Eigen::Index i = 0; i < cells; ++i) {
        AddAnchor(Channels(first + i, channel_count, Eigen::InnerStride<>(cells)),
                  {static_cast<double>(i % columns), static_cast<double>(i / columns)}, stride,
                  kAnchors.at(level).at(static_cast<size_t>(anchor)), layout, filter, candidates);
      }
    }
  }
  return candidates;
}

}  // namespace hullslam
