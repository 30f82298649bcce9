// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <opencv2/core/types.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "segmentation/candidate.h"
#include "segmentation/network.h"

namespace hullslam {

// What the outputs of a network mean. It follows from their shapes.
struct NetworkLayout {
  // The decoder of the outputs; a new kind of network is a new file with such a function, and a row
  // in network_layout.cc.
  using Decoder = std::vector<Candidate> (*)(const NetworkLayout& layout,
                                             std::span<const NetworkOutput> outputs,
                                             const CandidateFilter& filter);
  std::string name = {};  // for messages
  Decoder decode = nullptr;
  cv::Size input = {};
  int class_count = 0;
  int coefficient_count = 0;              // of a mask; 0: the network finds only boxes
  std::vector<size_t> heads = {};         // the outputs to decode, the one with most cells first
  std::optional<size_t> prototypes = {};  // the output with the prototypes of the masks
};

// Recognises the outputs of a network whose input has this size. `known_classes` is the number of
// names that the user or the file gives; absent if there are none. It decides where the shapes fit
// several layouts. Throws InputError with the shapes and the reason if no layout fits, or several.
NetworkLayout RecogniseLayout(std::span<const NetworkOutput> outputs, const cv::Size& input,
                              std::optional<size_t> known_classes);

// "head0 1x176x60x80, output1 1x32x120x160".
std::string DescribeOutputs(std::span<const NetworkOutput> outputs);

}  // namespace hullslam
