// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/open_images.h"

#include <algorithm>
#include <array>
#include <string>
#include <system_error>

#include "hullslam/sequences/bag_sequence.h"
#include "hullslam/sequences/euroc_sequence.h"
#include "hullslam/sequences/image_stream.h"
#include "hullslam/sequences/stereo_sequence.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/util/error.h"
#include "sequences/image_file.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

bool Exists(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

bool IsBag(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    return Exists(path / "metadata.yaml");
  }
  constexpr std::array kEndings = {".bag", ".db3", ".mcap"};
  return std::ranges::find(kEndings, path.extension().string()) != kEndings.end();
}

bool IsTum(const fs::path& folder) {
  try {
    CheckTumFolder(folder);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

ImageSequence OpenFolder(const fs::path& folder) {
  if (Exists(folder / "rgb.csv") && Exists(folder / "rgb_0")) {  // VSLAM-LAB
    return OpenImageStream(folder / "rgb_0").images;
  }
  if (Exists(folder / "mav0" / "cam0") || Exists(folder / "cam0" / "data.csv")) {
    return OpenEurocSequence(folder).images;
  }
  if (Exists(folder / "image_0") || Exists(folder / "image_2")) {
    return OpenKittiImages(folder).images;
  }
  if (Exists(folder / "left") && Exists(folder / "right")) {
    return OpenStereoFolder(folder);
  }
  if (IsTum(folder)) {
    return OpenTumSequence(folder, {.use_depth = false});
  }
  return OpenImageStream(folder).images;
}

}  // namespace

ImageSequence OpenImages(const fs::path& path, const OpenImagesOptions& options) {
  if (options.has_two_halves) {
    return OpenStereoFolder(path);
  }
  if (IsBag(path)) {
    return OpenBagSequence(
               path, {.image_topic = options.image_topic, .use_depth = false, .need_camera = false})
        .images;
  }
  std::error_code error;
  return fs::is_directory(path, error) ? OpenFolder(path) : OpenImageStream(path).images;
}

cv::Mat ReadFrameColour(const ImageSequence& sequence, const FramePaths& frame) {
  return sequence.load_colour != nullptr ? sequence.load_colour(frame)
                                         : ReadColourImage(frame.image);
}

}  // namespace hullslam
