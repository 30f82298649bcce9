// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string_view>

#include "segmentation/network.h"

namespace hullslam {

// Makes the network of the bytes of a file of ONNX. OpenCV's module dnn and the libraries that it
// needs are loaded at the first call: if programs were linked with them, each start would take
// longer. Throws cv::Exception if OpenCV cannot read the file, InputError if HullSLAM was built
// without HULLSLAM_WITH_SEGMENTATION, and std::runtime_error if a library is missing.
std::unique_ptr<Network> OpenNetwork(std::string_view bytes);

}  // namespace hullslam
