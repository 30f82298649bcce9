// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace hullslam {

// The frames of a video file, decoded with FFmpeg one after the other. Frames are turned as the
// container asks, as all players do. Only containers that are common for videos are read, because
// FFmpeg also knows lists of files, which would let a video open other files.
class VideoFile {
 public:
  // Throws InputError if it is no file, none that can be decoded, or if its images have more than
  // kMostImagePixels (image_file.h).
  explicit VideoFile(std::filesystem::path path);
  ~VideoFile();

  // The time stamps of all frames, s, as the container has them, from the beginning of its stream
  // of images; not a number for a frame without one. Decodes the whole video, because only a
  // decoder knows which packets become frames, and in which order. Throws InputError if no frame
  // can be decoded.
  std::vector<double> ReadStamps();
  // The frame with this number, counted from 0; CV_8UC1. All frames between the last frame that was
  // read and this one are decoded too; to go back, decoding starts again at the first frame. Throws
  // InputError if the frame cannot be decoded.
  cv::Mat ReadGrey(size_t number);
  // The same in colour; CV_8UC3 with blue first.
  cv::Mat ReadColour(size_t number);
  // How the frames are turned, such as "turned by 90 degrees clockwise"; empty if they are not.
  std::string DescribeTurn() const;

 private:
  class Decoder;

  void Rewind();

  std::filesystem::path path_;
  std::unique_ptr<Decoder> decoder_;
  size_t next_ = 0;  // number of the frame that is decoded next
};

}  // namespace hullslam
