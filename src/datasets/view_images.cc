// SPDX-License-Identifier: GPL-3.0-or-later
#include "datasets/view_images.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "camera/fit_depth.h"
#include "images/image_file.h"

namespace hullslam {
namespace {

// Whether the images are files of their own, which are used as they are.
bool AreFiles(const ImageSequence& sequence) {
  return sequence.load.target<ImageInput (*)(const FramePaths&, const PinholeCamera&)>() != nullptr;
}

}  // namespace

bool HasImage(const ImageSequence& sequence, const FramePaths& frame) {
  std::error_code error;
  return !AreFiles(sequence) || std::filesystem::exists(frame.image, error);
}

ViewImages ReadView(const ImageSequence& sequence, const FramePaths& frame,
                    const PinholeCamera& camera, bool with_image) {
  ViewImages view;
  if (AreFiles(sequence)) {  // which are read one by one
    view.grey = with_image && HasImage(sequence, frame) ? ReadGreyImage(frame.image) : cv::Mat();
    view.depth = frame.depth.empty() ? cv::Mat() : ReadDepthImage(frame.depth);
  } else if (with_image || !frame.depth.empty()) {
    ImageInput image = sequence.load(frame, camera);
    view = {.grey = std::move(image.grey), .depth = std::move(image.depth)};
  }
  view.depth = FitDepth(view.depth, {camera.width, camera.height});
  return view;
}

}  // namespace hullslam
