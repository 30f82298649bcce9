// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/image_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "camera/fit_depth.h"
#include "hullslam/util/error.h"
#include "results/pose_file.h"
#include "sequences/image_file.h"
#include "sequences/image_list.h"

namespace hullslam {
namespace {

// Keeps the poses of the selected frames, with their stamps.
void TakeFrames(const ImageSequence& sequence, PoseFile& file) {
  constexpr double kUnused = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> stamps(std::max(sequence.available, sequence.frames.back().number + 1),
                             kUnused);
  for (const FramePaths& frame : sequence.frames) {
    stamps.at(frame.number) = frame.timestamp;
  }
  SetStamps(*sequence.groundtruth, stamps, file);
  std::erase_if(file.poses, [](const StampedPose& pose) { return std::isnan(pose.timestamp); });
}

}  // namespace

ImageInput LoadFrame(const FramePaths& frame, const PinholeCamera& camera) {
  ImageInput image{frame.timestamp, ReadGreyImage(frame.image),
                   frame.depth.empty() ? cv::Mat() : ReadDepthImage(frame.depth)};
  if (!frame.depth.empty() && !HaveSameShape(image.depth.size(), image.grey.size())) {
    throw InputError(fmt::format("{}: {}x{} px, expected the shape of its colour image {}, {}x{}",
                                 frame.depth.string(), image.depth.cols, image.depth.rows,
                                 frame.image.filename().string(), image.grey.cols,
                                 image.grey.rows));
  }
  CheckImageSize(frame.image.string(), image.grey, camera);
  return image;
}

Trajectory AsRead(const ImageSequence& sequence, Trajectory poses) {
  return sequence.cam_from_read ? OfOtherCamera(std::move(poses), *sequence.cam_from_read)
                                : std::move(poses);
}

Trajectory AsLoaded(const ImageSequence& sequence, Trajectory poses) {
  return sequence.cam_from_read ? OfOtherCamera(std::move(poses), Inverse(*sequence.cam_from_read))
                                : std::move(poses);
}

std::optional<Trajectory> ReadGroundtruth(const ImageSequence& sequence,
                                          std::vector<std::string>* notes) {
  if (sequence.converted_groundtruth) {
    return AsLoaded(sequence, *sequence.converted_groundtruth);
  }
  if (!sequence.groundtruth) {
    return std::nullopt;
  }
  PoseFile file = ReadPoseFile(*sequence.groundtruth);
  if (!file.has_stamps) {  // one pose for each image of the whole sequence
    TakeFrames(sequence, file);
  }
  if (notes != nullptr) {
    notes->insert(notes->end(), file.notes.begin(), file.notes.end());
  }
  return AsLoaded(sequence, std::move(file.poses));
}

}  // namespace hullslam
