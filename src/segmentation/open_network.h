// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

#include "segmentation/network.h"

namespace hullslam {

// Opens the network in a file of ONNX with these bytes. OpenCV reads and runs it in a program of
// its own (network_program/), so a network with which OpenCV crashes ends that program only, and a
// program that makes no masks does not load OpenCV's module dnn. `threads` is how many OpenCV uses;
// 0: as many as it has. Throws NetworkError if OpenCV cannot read the network, and
// std::runtime_error if the program cannot be started.
std::unique_ptr<Network> OpenNetwork(std::string bytes, int threads = 0);

}  // namespace hullslam
