// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/image_stream.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <system_error>
#include <vector>

#include "hullslam/util/error.h"
#include "sequences/image_file.h"
#include "sequences/image_list.h"
#include "sequences/named_images.h"
#include "sequences/video_file.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr double kDefaultFramesPerSecond = 30.0;

ImageInput LoadPicture(const FramePaths& frame, const PinholeCamera& camera) {
  ImageInput image{frame.timestamp, ReadGreyImage(frame.image), cv::Mat()};
  CheckImageSize(frame.image.string(), image.grey, camera);
  return image;
}

void CheckFrameRate(const std::optional<double>& frames_per_second) {
  constexpr double kLeast = 0.01;
  constexpr double kMost = 10'000.0;
  if (frames_per_second && !(*frames_per_second >= kLeast && *frames_per_second <= kMost)) {
    throw InputError(fmt::format("--fps is '{:g}', expected a number from {:g} to {:g}",
                                 *frames_per_second, kLeast, kMost));
  }
}

void CheckOffset(double seconds) {
  constexpr double kLargest = 1e11;  // later than any clock that counts from 1970
  if (!(std::abs(seconds) <= kLargest)) {
    throw InputError(
        fmt::format("--stamp-offset is '{:g}', expected a number of seconds", seconds));
  }
}

ImageStream OpenFolder(const fs::path& folder, const ImageStreamOptions& options) {
  ImageStream stream;
  stream.frames_per_second = options.frames_per_second.value_or(kDefaultFramesPerSecond);
  stream.images.stamps_note =
      fmt::format("time stamps: {:g} images per second{}", stream.frames_per_second,
                  options.frames_per_second ? " (--fps)" : ", the default (--fps says another)");
  for (const fs::path& image : ListImages(folder)) {
    const size_t number = stream.images.frames.size();
    stream.images.frames.push_back(
        {static_cast<double>(number) / stream.frames_per_second, image, {}, number});
  }
  const cv::Mat first = ReadGreyImage(stream.images.frames.front().image);
  stream.width = first.cols;
  stream.height = first.rows;
  stream.images.load = LoadPicture;
  SelectFrames(folder, options.selection, stream.images);
  CheckImagesExist(stream.images.frames);
  return stream;
}

void CheckStamps(const fs::path& file, const std::vector<double>& stamps) {
  for (size_t i = 0; i < stamps.size(); ++i) {
    const bool is_good = std::isfinite(stamps[i]) && (i == 0 || stamps[i] > stamps[i - 1]);
    if (!is_good) {
      throw InputError(fmt::format(
          "{}: the time stamp of frame {}, {:g} s, does not come after the previous one; expected "
          "--fps N in place of the time stamps of the video",
          file.string(), i, stamps[i]));
    }
  }
}

ImageStream OpenVideo(const fs::path& file, const ImageStreamOptions& options) {
  const auto video = std::make_shared<VideoFile>(file);
  std::vector<double> stamps = video->ReadStamps();
  ImageStream stream;
  if (options.frames_per_second) {
    stream.frames_per_second = *options.frames_per_second;
    stream.images.stamps_note =
        fmt::format("time stamps: {:g} images per second (--fps)", stream.frames_per_second);
    for (size_t i = 0; i < stamps.size(); ++i) {
      stamps[i] = static_cast<double>(i) / stream.frames_per_second;
    }
  } else {
    CheckStamps(file, stamps);
    stream.frames_per_second =
        stamps.size() < 2 ? kDefaultFramesPerSecond
                          : static_cast<double>(stamps.size() - 1) / (stamps.back() - stamps[0]);
    stream.images.stamps_note = fmt::format(
        "time stamps: those of the video, {:.4g} images per second", stream.frames_per_second);
  }
  for (size_t i = 0; i < stamps.size(); ++i) {
    stream.images.frames.push_back({stamps[i], file / fmt::format("{:06}", i), {}, i});
  }
  const cv::Mat first = video->ReadGrey(0);
  stream.width = first.cols;
  stream.height = first.rows;
  stream.images.load = [video](const FramePaths& frame, const PinholeCamera& camera) {
    ImageInput image{frame.timestamp, video->ReadGrey(frame.number), cv::Mat()};
    CheckImageSize(frame.image.string(), image.grey, camera);
    return image;
  };
  stream.images.load_colour = [video](const FramePaths& frame) {
    return video->ReadColour(frame.number);
  };
  SelectFrames(file, options.selection, stream.images);
  return stream;
}

}  // namespace

ImageStream OpenImageStream(const fs::path& path, const ImageStreamOptions& options) {
  CheckFrameRate(options.frames_per_second);
  CheckOffset(options.stamp_offset);
  std::error_code error;
  if (!fs::exists(path, error)) {
    throw InputError(path.string() +
                     ": no such file or folder, expected a video or a folder of "
                     "images");
  }
  ImageStream stream =
      fs::is_directory(path, error) ? OpenFolder(path, options) : OpenVideo(path, options);
  for (FramePaths& frame : stream.images.frames) {
    frame.timestamp += options.stamp_offset;
  }
  return stream;
}

PinholeCamera CameraOfFieldOfView(double degrees, int width, int height) {
  constexpr double kLeast = 10.0;
  constexpr double kMost = 170.0;
  if (!(degrees >= kLeast && degrees <= kMost)) {
    throw InputError(
        fmt::format("--fov is '{:g}', expected the horizontal field of view, from {:g} "
                    "to {:g} degrees",
                    degrees, kLeast, kMost));
  }
  constexpr double kRadians = std::numbers::pi / 180.0;
  const double focal_length = 0.5 * width / std::tan(0.5 * degrees * kRadians);
  return {.fx = focal_length,
          .fy = focal_length,
          .cx = 0.5 * (width - 1),
          .cy = 0.5 * (height - 1),
          .width = width,
          .height = height};
}

}  // namespace hullslam
