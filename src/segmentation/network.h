// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace hullslam {

struct NetworkOutput {
  std::string name;
  cv::Mat values;  // CV_32F, with the dimensions of the output
};

// A network that OpenCV runs. The class that implements it is in a shared library of its own
// (open_network.h).
class Network {
 public:
  Network() = default;
  virtual ~Network() = default;
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  // `input` has the dimensions 1 x channels x height x width. The outputs are in the order of the
  // file. Throws cv::Exception if OpenCV cannot run the network with this size.
  virtual std::vector<NetworkOutput> Run(const cv::Mat& input) = 0;
};

// The function of the shared library, which has this name there. `bytes` is a file of ONNX.
extern "C" Network* HullslamMakeNetwork(const char* bytes, size_t size);

}  // namespace hullslam
