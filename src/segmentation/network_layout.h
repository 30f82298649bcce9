// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <opencv2/core/types.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "segmentation/candidate.h"
#include "segmentation/open_network.h"

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

inline constexpr int kAnchorsPerCell = 3;

// Decodes the maps of YOLOv5, 1 x (3 * (5 + classes + coefficients)) x rows x columns. For each of
// the three anchors of a cell, the channels are the logits of x, y, width, height, objectness and
// classes, and the coefficients. With the sigmoid s, the centre of the box is 2 s - 0.5 cells from
// the corner of the cell, and its size is (2 s)^2 times the anchor's. The anchors are as in
// the networks that were trained on COCO, which nearly all others keep; the maps do not have
// them.
std::vector<Candidate> DecodeAnchors(const NetworkLayout& layout,
                                     std::span<const NetworkOutput> outputs,
                                     const CandidateFilter& filter);

// Each of the four sides of a box is a distribution over this many distances, in strides.
inline constexpr int kDistances = 16;
inline constexpr int kBoxChannels = 4 * kDistances;

// Decodes the maps of YOLOv8 and YOLO11, 1 x (kBoxChannels + classes + coefficients) x rows x
// columns. The channels of a cell are the logits of the distances of the left, upper, right and
// lower side from the centre of the cell, the logits of the classes, and the coefficients. A
// distance is the mean of its distribution, the softmax of the logits.
std::vector<Candidate> DecodeCells(const NetworkLayout& layout,
                                   std::span<const NetworkOutput> outputs,
                                   const CandidateFilter& filter);

// Decodes the output of YOLOv8 and YOLO11 with the decoding of the exporter, 1 x (4 + classes +
// coefficients) x cells: the centre, width and height of the box, px, the scores of the classes,
// and the coefficients.
std::vector<Candidate> DecodeColumns(const NetworkLayout& layout,
                                     std::span<const NetworkOutput> outputs,
                                     const CandidateFilter& filter);

// Decodes YOLOv5's output, 1 x anchors x (5 + classes + coefficients): the box as above, the score
// of an object, the scores of the classes, and the coefficients. A candidate has the product of
// both scores.
std::vector<Candidate> DecodeRows(const NetworkLayout& layout,
                                  std::span<const NetworkOutput> outputs,
                                  const CandidateFilter& filter);

}  // namespace hullslam
