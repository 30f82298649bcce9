// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/video_file.h"

#include <fmt/format.h>

#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <system_error>
#include <utility>

#include "hullslam/util/error.h"
#include "sequences/image_file.h"
#include "sequences/image_list.h"

namespace hullslam {
namespace {

// In the syntax of OpenCV: the demuxers by FFmpeg's names, and reading of local files only.
constexpr const char* kFfmpegOptions =
    "format_whitelist;mov,matroska,avi,mpeg,mpegts,mpegvideo,m4v,h264,hevc,asf,flv,ogg,mjpeg,ivf,"
    "yuv4mpegpipe,gif|protocol_whitelist;file";

}  // namespace

VideoFile::VideoFile(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path_, error)) {
    throw InputError(path_.string() + ": is not a file, expected a video");
  }
  // Videos are opened before the threads of a run begin.
  // NOLINTNEXTLINE(concurrency-mt-unsafe)
  ::setenv("OPENCV_FFMPEG_CAPTURE_OPTIONS", kFfmpegOptions, /*replace=*/0);
  Rewind();
}

void VideoFile::Rewind() {
  // FFmpeg is chosen explicitly, because other backends of OpenCV take some names for patterns of
  // image files.
  if (!capture_.open(path_.string(), cv::CAP_FFMPEG)) {
    throw InputError(path_.string() +
                     ": cannot be decoded, expected a video that FFmpeg can read, or a folder of "
                     "images");
  }
  const double width = capture_.get(cv::CAP_PROP_FRAME_WIDTH);
  const double height = capture_.get(cv::CAP_PROP_FRAME_HEIGHT);
  if (width * height > static_cast<double>(kMostImagePixels)) {
    throw InputError(fmt::format("{}: has images of {}x{} px, expected up to {} million px",
                                 path_.string(), width, height, kMostImagePixels / 1'000'000));
  }
  next_ = 0;
}

std::vector<double> VideoFile::ReadStamps() {
  constexpr double kMilliseconds = 1000.0;
  Rewind();
  std::vector<double> stamps;
  while (capture_.grab()) {
    stamps.push_back(capture_.get(cv::CAP_PROP_POS_MSEC) / kMilliseconds);
    if (stamps.size() > kMostImages) {
      throw InputError(fmt::format("{}: more than {} frames", path_.string(), kMostImages));
    }
  }
  if (stamps.empty()) {
    throw InputError(path_.string() + ": no frame of the video can be decoded");
  }
  Rewind();
  return stamps;
}

cv::Mat VideoFile::ReadColour(size_t number) {
  if (number < next_) {
    Rewind();
  }
  bool is_grabbed = true;
  for (; is_grabbed && next_ <= number; ++next_) {
    is_grabbed = capture_.grab();
  }
  cv::Mat image;
  if (!is_grabbed || !capture_.retrieve(image) || image.empty()) {
    throw InputError(fmt::format("{}: frame {} cannot be decoded", path_.string(), number));
  }
  return image;
}

cv::Mat VideoFile::ReadGrey(size_t number) {
  // FFmpeg's images are converted to BGR with 8 bits by OpenCV.
  cv::Mat grey;
  cv::cvtColor(ReadColour(number), grey, cv::COLOR_BGR2GRAY);
  return grey;
}

}  // namespace hullslam
