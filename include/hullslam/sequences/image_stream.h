// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "hullslam/camera/pinhole.h"
#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

struct ImageStreamOptions {
  // If it is given, the time stamps are index / frames_per_second. Otherwise a video has its own
  // time stamps, and a folder has 30 images per second.
  std::optional<double> frames_per_second = {};
  double stamp_offset = 0.0;  // s, added to all time stamps
  FrameSelection selection = {};
};

// Images without depth and without ground truth, from a video file or a folder.
struct ImageStream {
  ImageSequence images;
  int width = 0;  // width of the first image, px
  int height = 0;
  double frames_per_second = 0.0;  // the mean over all frames
};

// Opens a video file or a folder.
//
// A folder: its PNG and JPEG images in the natural order of their names (frame2 before frame10).
// Images with 16 bits per channel are refused when they are loaded, because they may be depth
// images or use only a few of their bits.
//
// A video: any file that FFmpeg can decode. It is decoded once to find its frames and their time
// stamps, and again when the frames are loaded. The names of its frames are their numbers,
// "000000", "000001", and so on.
//
// Throws InputError for a path that is neither, a folder without images or with images in another
// format, a video that cannot be decoded, and stamps of a video that do not increase (it asks for
// --fps).
ImageStream OpenImageStream(const std::filesystem::path& path,
                            const ImageStreamOptions& options = {});

// A camera for a first try with images whose calibration is unknown: square pixels, the principal
// point in the middle, no distortion. `degrees` is the horizontal field of view. Throws InputError
// that names --fov unless it is from 10 to 170 degrees.
PinholeCamera CameraOfFieldOfView(double degrees, int width, int height);

}  // namespace hullslam
