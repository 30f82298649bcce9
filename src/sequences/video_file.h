// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <opencv2/videoio.hpp>
#include <vector>

namespace hullslam {

// The frames of a video file, decoded with FFmpeg one after the other. Only containers that are
// common for videos are read, because FFmpeg also knows lists of files, which would let a video
// open other files. OpenCV only takes such options of FFmpeg from the environment: the constructor
// sets OPENCV_FFMPEG_CAPTURE_OPTIONS, unless the user has set it.
class VideoFile {
 public:
  // Throws InputError if it is no file, none that can be decoded, or if its images have more than
  // kMostImagePixels (image_file.h).
  explicit VideoFile(std::filesystem::path path);

  // The time stamps of all frames, s. Decodes the whole video. Throws InputError if no frame can be
  // decoded.
  std::vector<double> ReadStamps();
  // The frame with this number, counted from 0; CV_8UC1. All frames between the last frame that was
  // read and this one are decoded too; to go back, decoding starts again at the first frame. Throws
  // InputError if the frame cannot be decoded.
  cv::Mat ReadGrey(size_t number);
  // The same in colour; CV_8UC3 with blue first.
  cv::Mat ReadColour(size_t number);

 private:
  void Rewind();

  std::filesystem::path path_;
  cv::VideoCapture capture_;
  size_t next_ = 0;  // number of the frame that is decoded next
};

}  // namespace hullslam
