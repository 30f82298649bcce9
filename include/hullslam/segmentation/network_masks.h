// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <mutex>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/masks/mask_source.h"
#include "hullslam/segmentation/segmenter.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/util/stage_timer.h"

namespace hullslam {

// The masks that a network makes of the images of a sequence when they are read.
class NetworkMasks final : public MaskSource {
 public:
  // The first frame and every `every`-th one after it are read with masks; 0: none. The sequence
  // and the camera must outlive this object. Throws InputError as Segmenter does.
  NetworkMasks(const std::filesystem::path& network, const SegmenterOptions& options, size_t every,
               const ImageSequence& sequence, const PinholeCamera& camera);

  std::string format() const override { return "network"; }
  bool Contains(const MaskFrame& /*frame*/) const override { return true; }
  std::string Example() const override { return {}; }
  // Decodes the image of the frame, so it is to be called like ImageSequence::load.
  FrameMasks Read(const MaskFrame& frame) const override;

  // The image of a frame in colour. To be called like ImageSequence::load.
  cv::Mat LoadImage(size_t frame) const;
  // The masks of such an image, which are in the pixels of the image that ImageSequence::load
  // gives; absent if the network fails on it. May be called by any thread.
  std::optional<std::vector<InstanceMask>> Make(const cv::Mat& image) const;
  // What Make() has done.
  struct Work {
    StageTimes times = {};           // "segment": of each image
    size_t failures = 0;             // images without masks
    std::string first_failure = {};  // why the first of them has none
  };
  Work work() const;
  const std::filesystem::path& path() const { return path_; }
  const std::string& hash() const { return segmenter_.network_hash(); }
  size_t every() const { return every_; }
  // Whether Read gives the masks of this frame of the sequence.
  bool IsRead(size_t frame) const { return every_ > 0 && frame % every_ == 0; }
  const std::vector<std::string>& class_names() const { return segmenter_.class_names(); }
  std::string Describe() const { return segmenter_.Describe(); }

 private:
  mutable std::mutex mutex_;  // guards the two members below
  mutable Segmenter segmenter_;
  mutable Work work_;
  const std::filesystem::path path_;
  const size_t every_;
  const ImageSequence& sequence_;
  const PinholeCamera camera_;
};

}  // namespace hullslam
