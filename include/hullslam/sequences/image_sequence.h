// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/image_input.h"
#include "hullslam/geometry/trajectory.h"
#include "hullslam/util/eigen_alignment.h"

namespace hullslam {

// The files of one frame.
struct FramePaths {
  double timestamp = 0.0;  // time stamp of the image, s
  std::filesystem::path image;
  std::filesystem::path depth = {};  // empty: no depth
  size_t number = 0;                 // index among all images of the sequence, from 0
  std::filesystem::path right = {};  // the right image of a stereo camera; empty: none
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
using ColourLoader = std::function<cv::Mat(const FramePaths& frame)>;

// The frames of a data set of any kind. The function that opens it checks everything that needs no
// decoding.
struct ImageSequence {
  std::vector<FramePaths> frames;  // the selected frames, in order of time
  size_t available = 0;  // frames of the whole sequence, of which `frames` is the selection
  size_t unpaired = 0;   // images of the whole sequence without a depth or a right image
  // The file with the true trajectory. Absent if there is none, or if its stamps or poses must be
  // converted before they can be compared with those of a run.
  std::optional<std::filesystem::path> groundtruth;
  // The converted true trajectory, if the stamps, axes or format of its file differ from those of a
  // run.
  std::optional<Trajectory> converted_groundtruth;
  // Messages for the user about faults in the files that do not end a run.
  std::vector<std::string> warnings = {};
  // Tells the user where the time stamps are from; empty if a list of the data set has them.
  std::string stamps_note = {};
  // The kind of data set: "tum", "icl", "euroc", "bag", "video", "kitti", ...; and what was chosen
  // among several possibilities, such as "image_topic". OpenRunSequence() needs both to open the
  // same images again.
  std::string dataset = {};
  std::map<std::string, std::string> choices = {};
  // Decodes a frame. To be called for the frames in order, by one thread at a time.
  FrameLoader load = LoadFrame;
  // Decodes the image of a frame in colour, CV_8UC3 with blue first. To be called like `load`. Null
  // if the images are files of their own.
  ColourLoader load_colour = nullptr;
  // Moves a mask of the image as read into the image that `load` gives. Null if they are the same.
  std::function<void(InstanceMask&)> fit_mask = nullptr;
  // The same for the right image.
  std::function<void(InstanceMask&)> fit_right_mask = nullptr;
  // The same for one mask of all images, 0 or 255, or of all right images. The result may have
  // values between.
  std::function<cv::Mat(const cv::Mat&)> fit_mask_all = nullptr;
  std::function<cv::Mat(const cv::Mat&)> fit_right_mask_all = nullptr;
  // The rotation of the camera of the images that `load` gives, if it turns them; the centre is the
  // same. The poses that a run writes are those of the camera as read.
  std::optional<Rigid3> cam_from_read = std::nullopt;
  // The size of the images as read, px, if `load` resizes them; else 0.
  int read_width = 0;
  int read_height = 0;
};

// Poses of the camera of the images that the sequence gives, as those of the camera as read.
Trajectory AsRead(const ImageSequence& sequence, Trajectory poses);
// The inverse of AsRead().
Trajectory AsLoaded(const ImageSequence& sequence, Trajectory poses);

// The true trajectory of the camera of the images that the sequence gives, from the field that is
// set, which is that of the camera as read; absent without ground truth. The file may have
// any of the forms in docs/outputs.md. What was converted or skipped is added to `notes`. Throws
// InputError for a file that cannot be used.
std::optional<Trajectory> ReadGroundtruth(const ImageSequence& sequence,
                                          std::vector<std::string>* notes = nullptr);

}  // namespace hullslam
