// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/stereo_loading.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>
#include <vector>

#include "hullslam/util/error.h"
#include "sequences/image_file.h"
#include "sequences/image_list.h"

namespace hullslam {
namespace {

using Rectifier = std::shared_ptr<const StereoRectifier>;

ImageInput Rectify(const Rectifier& rectifier, double timestamp, const cv::Mat& left,
                   const cv::Mat& right) {
  ImageInput pair{timestamp, left, cv::Mat()};
  pair.right = right;
  if (rectifier != nullptr) {
    pair.grey = rectifier->RectifyLeft(left);
    pair.right = rectifier->RectifyRight(right);
  }
  return pair;
}

// Masks are moved into the rectified images. Poses are estimated of the rectified left camera, so
// its rotation is kept for those of the camera as read.
void FitMasks(const Rectifier& rectifier, ImageSequence& sequence) {
  if (rectifier != nullptr) {
    const Eigen::Quaterniond& q = rectifier->rectified_from_left().rotation;
    if (q.w() != 1.0) {  // a pair that is rectified as read is not turned
      sequence.cam_from_read = rectifier->rectified_from_left();
    }
    sequence.choices["rectified_from_left"] =
        fmt::format("{:.9f} {:.9f} {:.9f} {:.9f}", q.x(), q.y(), q.z(), q.w());
    sequence.fit_mask = [rectifier](InstanceMask& mask) { rectifier->RectifyLeft(mask); };
    sequence.fit_right_mask = [rectifier](InstanceMask& mask) { rectifier->RectifyRight(mask); };
    sequence.fit_mask_all = [rectifier](const cv::Mat& mask) {
      return rectifier->RectifyLeft(mask);
    };
    sequence.fit_right_mask_all = [rectifier](const cv::Mat& mask) {
      return rectifier->RectifyRight(mask);
    };
  }
}

cv::Mat Half(const cv::Mat& both, int half) {
  const int width = both.cols / 2;
  return both.colRange(half * width, (half + 1) * width).clone();
}

}  // namespace

// A pair has no depth images, so those of 16 bits are images too.
void LoadPairs(Rectifier rectifier, ImageSequence& sequence) {
  std::vector<std::filesystem::path> images;
  for (const FramePaths& frame : sequence.frames) {
    images.push_back(frame.image);
    images.push_back(frame.right);
  }
  const uint16_t brightest = BrightestOf(images);
  sequence.load = [rectifier, brightest](const FramePaths& frame, const PinholeCamera& camera) {
    const cv::Mat left = ReadGreyImage(frame.image, brightest);
    const cv::Mat right = ReadGreyImage(frame.right, brightest);
    CheckImageSize(frame.image.string(), left, camera);
    CheckImageSize(frame.right.string(), right, camera);
    return Rectify(rectifier, frame.timestamp, left, right);
  };
  sequence.load_colour = [rectifier, brightest](const FramePaths& frame) {
    const cv::Mat image = ReadColourImage(frame.image, brightest);
    return rectifier != nullptr ? rectifier->RectifyLeft(image) : image;
  };
  FitMasks(rectifier, sequence);
}

void RectifyPairs(Rectifier rectifier, ImageSequence& sequence) {
  sequence.load = [rectifier, load = sequence.load](const FramePaths& frame,
                                                    const PinholeCamera& camera) {
    const ImageInput pair = load(frame, camera);
    return Rectify(rectifier, frame.timestamp, pair.grey, pair.right);
  };
  sequence.load_colour = [rectifier, load = sequence.load_colour](const FramePaths& frame) {
    return rectifier->RectifyLeft(load(frame));
  };
  FitMasks(rectifier, sequence);
}

void SplitHalves(Rectifier rectifier, ImageSequence& sequence) {
  sequence.load = [rectifier, load = sequence.load](const FramePaths& frame,
                                                    const PinholeCamera& camera) {
    PinholeCamera of_both = camera;
    of_both.width *= 2;
    const ImageInput both = load(frame, of_both);
    return Rectify(rectifier, frame.timestamp, Half(both.grey, 0), Half(both.grey, 1));
  };
  sequence.load_colour = [rectifier, load = sequence.load_colour](const FramePaths& frame) {
    const cv::Mat left = Half(load != nullptr ? load(frame) : ReadColourImage(frame.image), 0);
    return rectifier != nullptr ? rectifier->RectifyLeft(left) : left;
  };
  FitMasks(rectifier, sequence);
}

}  // namespace hullslam
