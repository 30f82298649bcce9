// SPDX-License-Identifier: GPL-3.0-or-later
// The shared library hullslam_network, which open_network.cc loads.

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>

#include "segmentation/network.h"

namespace hullslam {
namespace {

class OpencvNetwork final : public Network {
 public:
  OpencvNetwork(const char* bytes, size_t size)
      : net_(cv::dnn::readNetFromONNX(bytes, size)), names_(net_.getUnconnectedOutLayersNames()) {
    net_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    net_.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
  }

  // The outputs are copies, because the next run writes over those of the network.
  std::vector<NetworkOutput> Run(const cv::Mat& input) override {
    std::vector<cv::Mat> values;
    net_.setInput(input);
    net_.forward(values, names_);
    std::vector<NetworkOutput> outputs;
    for (size_t i = 0; i < values.size(); ++i) {
      outputs.push_back({names_[i], values[i].clone()});
    }
    return outputs;
  }

 private:
  cv::dnn::Net net_;
  std::vector<std::string> names_;
};

}  // namespace

extern "C" __attribute__((visibility("default"))) Network* HullslamMakeNetwork(const char* bytes,
                                                                               size_t size) {
  // OpenCV also prints what its exceptions say, on several lines that name its source files.
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  return new OpencvNetwork(bytes, size);
}

}  // namespace hullslam
