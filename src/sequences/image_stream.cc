// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/image_stream.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <system_error>
#include <vector>

#include "hullslam/util/error.h"
#include "images/image_file.h"
#include "sequences/image_list.h"
#include "sequences/named_images.h"
#include "sequences/video_file.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr double kDefaultFramesPerSecond = 30.0;

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
  SelectFrames(folder, options.selection, stream.images);
  CheckImagesExist(stream.images.frames);
  return stream;
}

[[noreturn]] void FailStamp(const fs::path& file, size_t frame, const std::string& fault) {
  throw InputError(
      fmt::format("{}: frame {} {}; expected --fps N in place of the time stamps of the video",
                  file.string(), frame, fault));
}

// The frames of a video with its own time stamps. A frame that repeats the stamp of the previous
// one is left out: a container has it when a camera delivered a frame twice.
void AddFrames(const fs::path& file, const std::vector<double>& stamps, ImageSequence& sequence) {
  for (size_t i = 0; i < stamps.size(); ++i) {
    const double former = sequence.frames.empty() ? -std::numeric_limits<double>::infinity()
                                                  : sequence.frames.back().timestamp;
    if (!std::isfinite(stamps[i])) {
      FailStamp(file, i, "has no time stamp");
    }
    if (stamps[i] < former) {
      FailStamp(file, i,
                fmt::format("has the time stamp {:.6f} s, which comes before the previous "
                            "one, {:.6f} s",
                            stamps[i], former));
    }
    if (stamps[i] > former) {
      sequence.frames.push_back({stamps[i], file / fmt::format("{:06}", i), {}, i});
    }
  }
}

ImageStream OpenVideo(const fs::path& file, const ImageStreamOptions& options) {
  const auto video = std::make_shared<VideoFile>(file);
  std::vector<double> stamps = video->ReadStamps();
  ImageStream stream;
  if (options.frames_per_second) {
    for (size_t i = 0; i < stamps.size(); ++i) {
      stamps[i] = static_cast<double>(i) / *options.frames_per_second;
    }
  }
  AddFrames(file, stamps, stream.images);
  stream.frames_per_second =
      options.frames_per_second.value_or(MeanRate(stream.images.frames, kDefaultFramesPerSecond));
  const size_t repeated = stamps.size() - stream.images.frames.size();
  const std::string turn = video->DescribeTurn();
  stream.images.stamps_note = fmt::format(
      "time stamps: {}{:.4g} images per second{}{}{}",
      options.frames_per_second ? "" : "those of the video, ", stream.frames_per_second,
      options.frames_per_second ? " (--fps)" : "",
      repeated > 0 ? fmt::format("; {} repeat the previous stamp and are left out", repeated) : "",
      turn.empty() ? "" : fmt::format("; the images are {}, as the video asks", turn));
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
  stream.images.dataset = "video";
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
