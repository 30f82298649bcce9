// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/image_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>
#include <utility>
#include <vector>

#include "camera/fit_depth.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/util/error.h"
#include "images/image_file.h"
#include "results/pose_file.h"
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

FrameSelection ParseFrameRange(const std::string& option, const std::string& text, size_t frames) {
  const size_t colon = text.find(':');
  const std::string expected = fmt::format(
      "{}: '{}', expected FIRST:LAST with 0 <= FIRST <= LAST "
      "< {}, the number of frames",
      option, text, frames);
  if (colon == std::string::npos) {
    throw InputError(expected);
  }
  const auto parse = [&](const char* begin, const char* end, size_t missing) {
    size_t number = missing;
    if (begin != end) {
      const auto [rest, error] = std::from_chars(begin, end, number);
      if (error != std::errc() || rest != end) {
        throw InputError(expected);
      }
    }
    return number;
  };
  const char* const begin = text.data();
  const FrameSelection range{.first = parse(begin, begin + colon, 0),
                             .last = parse(begin + colon + 1, begin + text.size(), frames - 1)};
  if (range.first > range.last || range.last >= frames) {
    throw InputError(expected);
  }
  return range;
}

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
  image.depth_delay = frame.depth_delay;
  return image;
}

cv::Mat LoadFrameColour(const FramePaths& frame) { return ReadColourImage(frame.image); }

void AddWarp(ImageWarp warp, ImageSequence& sequence) {
  sequence.choices.insert(warp.choice);
  sequence.load = [load = std::move(sequence.load), warp](const FramePaths& frame,
                                                          const PinholeCamera& camera) {
    PinholeCamera before = camera;
    if (!warp.size_before.empty()) {
      before.width = warp.size_before.width;
      before.height = warp.size_before.height;
    }
    ImageInput image = load(frame, before);
    image.grey = warp.image(image.grey, ImageSide::kLeft, false);
    if (!image.right.empty()) {
      image.right = warp.image(image.right, ImageSide::kRight, false);
    }
    if (!image.depth.empty()) {
      image.depth = warp.image(image.depth, ImageSide::kLeft, true);
    }
    return image;
  };
  sequence.load_colour = [load = std::move(sequence.load_colour), warp](const FramePaths& frame) {
    return warp.image(load(frame), ImageSide::kLeft, false);
  };
  sequence.warps.push_back(std::move(warp));
}

cv::Size SizeAsRead(const ImageSequence& sequence, const PinholeCamera& camera) {
  for (const ImageWarp& warp : sequence.warps) {
    if (!warp.size_before.empty()) {
      return warp.size_before;
    }
  }
  return {camera.width, camera.height};
}

void FitMasks(std::span<const ImageWarp> warps, ImageSide side, std::vector<InstanceMask>& masks) {
  for (const ImageWarp& warp : warps) {
    for (InstanceMask& mask : masks) {
      for (std::vector<Eigen::Vector2d>& outline : mask.outlines) {
        for (Eigen::Vector2d& point : outline) {
          point = warp.pixel(point, side);
        }
      }
    }
  }
}

cv::Mat FitMaskAll(std::span<const ImageWarp> warps, ImageSide side, cv::Mat mask) {
  for (const ImageWarp& warp : warps) {
    mask = warp.image(mask, side, true);
  }
  return mask;
}

Trajectory AsRead(const ImageSequence& sequence, Trajectory poses) {
  for (auto warp = sequence.warps.rbegin(); warp != sequence.warps.rend(); ++warp) {
    if (warp->after_from_before) {
      poses = OfOtherCamera(std::move(poses), *warp->after_from_before);
    }
  }
  return poses;
}

Trajectory AsLoaded(const ImageSequence& sequence, Trajectory poses) {
  for (const ImageWarp& warp : sequence.warps) {
    if (warp.after_from_before) {
      poses = OfOtherCamera(std::move(poses), Inverse(*warp.after_from_before));
    }
  }
  return poses;
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

std::optional<Trajectory> TryGroundtruth(const ImageSequence& sequence,
                                         std::vector<std::string>& warnings) {
  try {
    std::vector<std::string> notes;
    std::optional<Trajectory> truth = ReadGroundtruth(sequence, &notes);
    for (const std::string& note : notes) {
      warnings.push_back("ground truth: " + note);
    }
    return truth;
  } catch (const InputError& error) {
    warnings.push_back(error.what() + std::string("; the run goes on without ground truth"));
    return std::nullopt;
  }
}

std::vector<double> StampsOf(std::span<const FramePaths> frames) {
  std::vector<double> stamps;
  for (const FramePaths& frame : frames) {
    stamps.push_back(frame.timestamp);
  }
  return stamps;
}

constexpr double kMaxOdometryGap = 0.5;  // s

void ReadOdometry(const std::filesystem::path& path, SensorKind sensor, ImageSequence& sequence) {
  if (path.empty()) {
    return;
  }
  if (sensor == SensorKind::kMonocular) {
    throw InputError(
        path.string() +
        ": the odometry is in metres, expected a camera with depth or a stereo camera, "
        "because the map of a monocular run is not");
  }
  const Trajectory& odometry = sequence.odometry.emplace(AsLoaded(sequence, ReadTrajectory(path)));
  const std::vector<double> stamps = StampsOf(sequence.frames);
  const auto covered = std::ranges::count_if(stamps, [&](double stamp) {
    return InterpolatePose(odometry, stamp, kMaxOdometryGap).has_value();
  });
  if (!stamps.empty() && covered == 0) {
    throw InputError(fmt::format(
        "{}: its stamps go from {:.3f} to {:.3f} s, expected those of the images, {:.3f} to {:.3f}",
        path.string(), odometry.front().timestamp, odometry.back().timestamp, stamps.front(),
        stamps.back()));
  }
  if (const size_t missing = stamps.size() - static_cast<size_t>(covered); missing > 0) {
    sequence.warnings.push_back(
        fmt::format("{}: {} of {} images have no odometry", path.string(), missing, stamps.size()));
  }
}

std::optional<MotionPrior> PriorBetween(const ImageSequence& sequence, double from, double to,
                                        const OdometryOptions& options) {
  if (!sequence.odometry) {
    return std::nullopt;
  }
  constexpr double kLeast = 1e-4;  // rad and m
  const std::optional<Rigid3> world_from_last =
      InterpolatePose(*sequence.odometry, from, kMaxOdometryGap);
  const std::optional<Rigid3> world_from_cam =
      InterpolatePose(*sequence.odometry, to, kMaxOdometryGap);
  if (!world_from_last || !world_from_cam) {
    return std::nullopt;
  }
  MotionPrior motion{.cam_from_last_cam = Inverse(*world_from_cam) * *world_from_last,
                     .last_timestamp = from};
  const Rigid3& step = motion.cam_from_last_cam;
  const double turn = std::max(kLeast, options.sigma_turn * LogSo3(step.rotation).norm());
  const double way = std::max(kLeast, options.sigma_way * step.translation.norm());
  motion.covariance.diagonal() << Eigen::Vector3d::Constant(turn * turn),
      Eigen::Vector3d::Constant(way * way);
  return motion;
}

}  // namespace hullslam
