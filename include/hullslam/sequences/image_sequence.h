// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/image_input.h"
#include "hullslam/geometry/trajectory.h"

namespace hullslam {

// The files of one frame.
struct FramePaths {
  double timestamp = 0.0;  // of the image, s
  std::filesystem::path image;
  std::filesystem::path depth = {};  // empty: no depth
  size_t number = 0;                 // index among all images of the sequence, from 0
};

// Selects the frames `first`, `first + stride`, ... up to and including `last`, counted from 0.
struct FrameSelection {
  size_t first = 0;
  size_t last = std::numeric_limits<size_t>::max();
  size_t stride = 1;
};

// Decodes one frame. Throws InputError for an image that ReadGreyImage() or ReadDepthImage()
// rejects, or that does not have the size of the camera. Without a depth file the depth is empty.
ImageInput LoadFrame(const FramePaths& frame, const PinholeCamera& camera);

using FrameLoader = std::function<ImageInput(const FramePaths& frame, const PinholeCamera& camera)>;

// The frames of a data set of any kind. The function that opens it checks everything that needs no
// decoding.
struct ImageSequence {
  std::vector<FramePaths> frames;  // the selected frames, in order of time
  size_t available = 0;  // frames of the whole sequence, of which `frames` is the selection
  size_t unpaired = 0;   // colour images of the whole sequence that have no depth image
  // The file with the true trajectory, if there is one whose stamps and poses can be compared with
  // the trajectory of a run as they are.
  std::optional<std::filesystem::path> groundtruth;
  // The true trajectory, if its file must not be compared with that of a run as it is, because its
  // stamps, its axes or its format are others.
  std::optional<Trajectory> converted_groundtruth;
  // How the time stamps were found, for the user; empty if a list of the data set has them.
  std::string stamps_note = {};
  // How a frame is decoded: in order, by one thread at a time.
  FrameLoader load = LoadFrame;
};

// The true trajectory, from whichever of the two fields has it; absent without ground truth. Throws
// InputError for a file that ReadTrajectory() rejects.
std::optional<Trajectory> ReadGroundtruth(const ImageSequence& sequence);

}  // namespace hullslam
