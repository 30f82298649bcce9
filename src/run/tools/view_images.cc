// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/tools/view_images.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "camera/fit_depth.h"
#include "sequences/image_file.h"

namespace hullslam {

bool HasImage(const ImageSequence& sequence, const FramePaths& frame) {
  std::error_code error;
  return sequence.load_colour != nullptr || std::filesystem::exists(frame.image, error);
}

ViewImages ReadView(const ImageSequence& sequence, const FramePaths& frame,
                    const PinholeCamera& camera, bool with_image) {
  ViewImages view;
  if (sequence.load_colour == nullptr) {  // the images are files, which are read one by one
    view.grey = with_image && HasImage(sequence, frame) ? ReadGreyImage(frame.image) : cv::Mat();
    view.depth = frame.depth.empty() ? cv::Mat() : ReadDepthImage(frame.depth);
  } else if (with_image || !frame.depth.empty()) {
    ImageInput image = sequence.load(frame, camera);
    view = {.grey = std::move(image.grey), .depth = std::move(image.depth)};
  }
  view.depth = FitDepth(view.depth, {camera.width, camera.height});
  return view;
}

void FitMasks(const ImageSequence& sequence, std::vector<InstanceMask>& masks) {
  if (sequence.fit_mask != nullptr) {
    std::ranges::for_each(masks, sequence.fit_mask);
  }
}

}  // namespace hullslam
