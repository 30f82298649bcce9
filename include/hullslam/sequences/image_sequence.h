// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/image_input.h"
#include "hullslam/frame/stereo_rectifier.h"
#include "hullslam/geometry/trajectory.h"
#include "hullslam/system/options.h"
#include "hullslam/util/eigen_alignment.h"

namespace hullslam {

// The files of one frame.
struct FramePaths {
  double timestamp = 0.0;  // time stamp of the image, s
  std::filesystem::path image;
  std::filesystem::path depth = {};  // empty: no depth
  size_t number = 0;                 // index among all images of the sequence, from 0
  std::filesystem::path right = {};  // the right image of a stereo camera; empty: none
  double depth_delay = 0.0;          // s, as in ImageInput
};

// Selects the frames `first`, `first + stride`, ... up to and including `last`, counted from 0.
struct FrameSelection {
  size_t first = 0;
  size_t last = std::numeric_limits<size_t>::max();
  size_t stride = 1;
};

// The frames FIRST:LAST of a sequence of so many frames, both inclusive; a missing number is the
// first or the last frame. Throws InputError, which begins with `option`, for any other text.
FrameSelection ParseFrameRange(const std::string& option, const std::string& text, size_t frames);

// Decodes one frame. Throws InputError for an image that ReadGreyImage() or ReadDepthImage()
// rejects, or that does not have the size of the camera. Without a depth file the depth is empty.
ImageInput LoadFrame(const FramePaths& frame, const PinholeCamera& camera);

// The image of the frame in colour, CV_8UC3 with blue first.
cv::Mat LoadFrameColour(const FramePaths& frame);

using FrameLoader = std::function<ImageInput(const FramePaths& frame, const PinholeCamera& camera)>;
using ColourLoader = std::function<cv::Mat(const FramePaths& frame)>;

// A step that changes the images as read, such as rectification.
struct ImageWarp {
  // What summary.json tells about the step: an entry of ImageSequence::choices.
  std::pair<std::string, std::string> choice = {};
  // Changes an image. In a step that resizes, each pixel gets the value of the nearest one if
  // `is_nearest`, as for depth and masks.
  std::function<cv::Mat(const cv::Mat& image, ImageSide side, bool is_nearest)> image = nullptr;
  // Moves a pixel of the image before the step to its position after it.
  std::function<Eigen::Vector2d(const Eigen::Vector2d& pixel, ImageSide side)> pixel = nullptr;
  // The rotation of the left camera, if the step turns it; the centre is the same.
  std::optional<Rigid3> after_from_before = std::nullopt;
  cv::Size size_before = {};  // px; empty if the step keeps the size
  std::shared_ptr<const StereoRectifier> rectifier = nullptr;  // if the step is rectification
};

// The frames of a data set of any kind. The function that opens it checks everything that needs no
// decoding.
struct ImageSequence {
  std::vector<FramePaths> frames;  // the selected frames, in order of time
  size_t available = 0;  // frames of the whole sequence, of which `frames` is the selection
  size_t unpaired = 0;   // images of the whole sequence without a depth or a right image
  // The file with the true trajectory. Absent if there is none, or if its stamps or poses must be
  // converted before they can be compared with a run.
  std::optional<std::filesystem::path> groundtruth;
  // The converted true trajectory, if the stamps, axes or format of its file are not as in a run's
  // trajectory.
  std::optional<Trajectory> converted_groundtruth;
  // Poses of the camera of the images that the sequence gives, by wheels or an inertial sensor.
  std::optional<Trajectory> odometry = {};
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
  // Decodes the image of a frame in colour. To be called like `load`.
  ColourLoader load_colour = LoadFrameColour;
  // The steps, in their order, by which both loaders change the images as read (AddWarp()). The
  // masks that a run reads and the poses that it writes belong to the images as read.
  std::vector<ImageWarp> warps = {};
};

// Adds a step at the end: to the warps, the choices and both loaders.
void AddWarp(ImageWarp warp, ImageSequence& sequence);

// The size of the images as read, px. `camera` belongs to the images that the sequence gives.
cv::Size SizeAsRead(const ImageSequence& sequence, const PinholeCamera& camera);

// Moves masks of an image as read into the image that a sequence with these warps gives.
void FitMasks(std::span<const ImageWarp> warps, ImageSide side, std::vector<InstanceMask>& masks);
// The same for one mask of all images, 0 or 255. The result may have values between.
cv::Mat FitMaskAll(std::span<const ImageWarp> warps, ImageSide side, cv::Mat mask);

// Converts poses of the camera of the images that the sequence gives to the camera as read.
Trajectory AsRead(const ImageSequence& sequence, Trajectory poses);
// The inverse of AsRead().
Trajectory AsLoaded(const ImageSequence& sequence, Trajectory poses);

// The time stamps of frames, s.
std::vector<double> StampsOf(std::span<const FramePaths> frames);

// The true trajectory of the camera of the images that the sequence gives, from the field that is
// set, which belongs to the camera as read; absent without ground truth. The file may have
// any of the forms in docs/outputs.md. What was converted or skipped is added to `notes`. Throws
// InputError for a file that cannot be used.
std::optional<Trajectory> ReadGroundtruth(const ImageSequence& sequence,
                                          std::vector<std::string>* notes = nullptr);
// The same for a run that can go on without it: what was converted or skipped, and why it cannot be
// used, is added to `warnings`.
std::optional<Trajectory> TryGroundtruth(const ImageSequence& sequence,
                                         std::vector<std::string>& warnings);

// Reads the odometry of the camera as read, in TUM's format; none if `path` is empty. Throws
// InputError for a bad file, for one without a pose at any image (in gaps of up to 0.5 s, poses are
// interpolated), and for a monocular camera, because odometry is in metres and its map is not. Adds
// a warning if some images have no odometry.
void ReadOdometry(const std::filesystem::path& path, SensorKind sensor, ImageSequence& sequence);

// The motion between two stamps (s) by the odometry of the sequence. The standard deviations are at
// least 0.1 mm and 0.1 mrad. Null if there is no odometry at one of them (InterpolatePose with gaps
// of up to 0.5 s).
std::optional<MotionPrior> PriorBetween(const ImageSequence& sequence, double from, double to,
                                        const OdometryOptions& options);

}  // namespace hullslam
