// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/icl_groundtruth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "hullslam/results/trajectory_file.h"
#include "hullslam/util/error.h"

namespace hullslam {

Rigid3 MirrorY(const Rigid3& world_from_cam) {
  // F R F is a rotation about the mirrored axis by the opposite angle, so the vector part (x, y, z)
  // of the quaternion becomes (-x, y, -z).
  const Eigen::Quaterniond& q = world_from_cam.rotation;
  const Eigen::Vector3d& t = world_from_cam.translation;
  return {Eigen::Quaterniond(q.w(), -q.x(), q.y(), -q.z()), Eigen::Vector3d(t.x(), -t.y(), t.z())};
}

Trajectory MirrorY(Trajectory trajectory) {
  for (StampedPose& pose : trajectory) {
    pose.world_from_cam = MirrorY(pose.world_from_cam);
  }
  return trajectory;
}

namespace {

// A frame with depth, and the pose that the ground truth gives it.
struct View {
  const FramePaths* frame = nullptr;
  Rigid3 world_from_cam;
};

std::vector<View> ObservationsOf(const ImageSequence& sequence, const Trajectory& trajectory) {
  constexpr double kSameFrame = 0.5 / kIclFramesPerSecond;
  std::vector<View> views;
  auto pose = trajectory.begin();
  for (const FramePaths& frame : sequence.frames) {
    pose = std::find_if(pose, trajectory.end(), [&](const StampedPose& candidate) {
      return candidate.timestamp > frame.timestamp - kSameFrame;
    });
    if (pose != trajectory.end() && pose->timestamp < frame.timestamp + kSameFrame &&
        !frame.depth.empty()) {
      views.push_back({&frame, pose->world_from_cam});
    }
  }
  return views;
}

std::optional<cv::Mat> LoadDepth(const ImageSequence& sequence, const FramePaths& frame,
                                 const PinholeCamera& camera) {
  try {
    return sequence.load(frame, camera).depth;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

float DepthAt(const cv::Mat& depth, const Eigen::Vector2d& pixel, const DepthOptions& options) {
  return SampleDepth(depth, pixel.cast<float>(), options.units_per_metre);
}

// The predicted pixel and depth of a point of one view in another view.
struct Prediction {
  Eigen::Vector2d pixel;
  double depth = 0.0;
};

std::optional<Prediction> Predict(const PinholeCamera& camera, const Rigid3& to_from_from,
                                  const Eigen::Vector3d& point) {
  constexpr double kNearest = 0.05;  // m
  const Eigen::Vector3d moved = to_from_from * point;
  if (moved.z() < kNearest) {
    return std::nullopt;
  }
  return Prediction{camera.Distort(camera.Project(moved)), moved.z()};
}

// Adds the votes of the pixels of one pair of images.
void CompareDepth(const PinholeCamera& camera, const DepthOptions& options, const cv::Mat& from,
                  const cv::Mat& to, const Rigid3& to_from_from, YAxisVotes& votes) {
  constexpr int kStep = 8;  // px
  constexpr double kTolerance =
      0.03;  // as a share of the depth; larger than the noise of depth images
  const Rigid3 mirrored = MirrorY(to_from_from);
  for (int v = kStep / 2; v < from.rows; v += kStep) {
    for (int u = kStep / 2; u < from.cols; u += kStep) {
      const Eigen::Vector2d pixel(u, v);
      const double depth = DepthAt(from, pixel, options);
      if (!(depth > 0.0)) {
        continue;
      }
      const Eigen::Vector3d point = camera.Unproject(camera.Undistort(pixel), depth);
      const auto down = Predict(camera, to_from_from, point);
      const auto up = Predict(camera, mirrored, point);
      if (!down || !up) {
        continue;
      }
      const double seen_down = DepthAt(to, down->pixel, options);
      const double seen_up = DepthAt(to, up->pixel, options);
      if (!(seen_down > 0.0 && seen_up > 0.0)) {
        continue;
      }
      const bool agree_down = std::abs(seen_down - down->depth) < kTolerance * down->depth;
      const bool agree_up = std::abs(seen_up - up->depth) < kTolerance * up->depth;
      ++votes.pixels;
      votes.both += agree_up && agree_down ? 1 : 0;
      votes.only_up += agree_up && !agree_down ? 1 : 0;
      votes.only_down += agree_down && !agree_up ? 1 : 0;
    }
  }
}

}  // namespace

Trajectory ReadIndexedTrajectory(const std::filesystem::path& path) {
  Trajectory trajectory = ReadTrajectory(path);
  for (StampedPose& pose : trajectory) {
    if (pose.timestamp < 0.0 || pose.timestamp != std::floor(pose.timestamp)) {
      throw InputError(fmt::format(
          "{}: time stamp {:.6f}, expected the index of a frame, as in ICL-NUIM's ground truth",
          path.string(), pose.timestamp));
    }
    pose.timestamp /= kIclFramesPerSecond;
  }
  return trajectory;
}

YAxisVotes MeasureYAxis(const ImageSequence& sequence, const Trajectory& as_given,
                        const PinholeCamera& camera, const DepthOptions& depth) {
  constexpr size_t kPairs = 16;
  constexpr double kApart = 0.5;  // s
  const std::vector<View> views = ObservationsOf(sequence, as_given);
  const size_t step = std::max<size_t>(1, views.size() / kPairs);
  YAxisVotes votes;
  for (size_t i = 0; i + 1 < views.size(); i += step) {
    size_t j = i + 1;
    while (j + 1 < views.size() && views[j].frame->timestamp < views[i].frame->timestamp + kApart) {
      ++j;
    }
    const auto from = LoadDepth(sequence, *views[i].frame, camera);
    const auto to = LoadDepth(sequence, *views[j].frame, camera);
    if (from && to) {
      CompareDepth(camera, depth, *from, *to,
                   Inverse(views[j].world_from_cam) * views[i].world_from_cam, votes);
    }
  }
  return votes;
}

}  // namespace hullslam
