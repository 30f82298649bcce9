// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace hullslam {

struct NetworkOutput {
  std::string name;
  cv::Mat values;  // CV_32F, with the dimensions of the output
};

// OpenCV cannot read or run a network. The message is a reason for a user.
class NetworkError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A network that OpenCV runs.
class Network {
 public:
  Network() = default;
  virtual ~Network() = default;
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  // `input` has the dimensions 1 x channels x height x width. The outputs are in the order of the
  // file. Throws NetworkError if OpenCV cannot run the network with this input; it can be run again
  // with another one.
  virtual std::vector<NetworkOutput> Run(const cv::Mat& input) = 0;
};

// Opens the network in a file of ONNX with these bytes. OpenCV reads and runs it in a program of
// its own (network_program/), so a network with which OpenCV crashes ends that program only, and a
// program that makes no masks does not load OpenCV's module dnn. `threads` is how many OpenCV uses;
// 0: as many as it has. Throws NetworkError if OpenCV cannot read the network, and
// std::runtime_error if the program cannot be started.
std::unique_ptr<Network> OpenNetwork(std::string bytes, int threads = 0);

}  // namespace hullslam
