// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/make_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "camera/fit_depth.h"
#include "datasets/view_images.h"
#include "frame/coarse_depth.h"
#include "frame/detection/mask_region.h"
#include "frame/rolling_shutter.h"
#include "hullslam/util/error.h"
#include "mesh/make_depth_view.h"
#include "sequences/image_list.h"
#include "util/lists.h"
#include "util/statistics.h"
#include "util/text.h"

namespace hullslam {
namespace {

constexpr size_t kMostBlocks = 50'000;  // 8 kB each, of all volumes together
constexpr double kTruncation = 4.0;     // voxels
constexpr size_t kLeastTriangles = 100;

// A frame that is used, with its pose.
struct MeshFrame {
  size_t frame = 0;  // index in the sequence
  size_t pose = 0;   // index in the trajectory
};

// The frames that have the stamps of these poses.
std::vector<MeshFrame> ChooseFrames(const MeshInput& input, size_t every) {
  std::vector<MeshFrame> chosen;
  size_t next_keyframe = 0;
  for (size_t i = 0; i < input.poses.size(); ++i) {
    const double stamp = input.poses[i].timestamp;
    while (next_keyframe < input.keyframes.size() &&
           input.keyframes[next_keyframe] < stamp - kSameMoment) {
      ++next_keyframe;
    }
    const bool is_keyframe = next_keyframe < input.keyframes.size() &&
                             input.keyframes[next_keyframe] <= stamp + kSameMoment;
    if (every > 0 ? i % every != 0 : !is_keyframe) {
      continue;
    }
    const FramePaths* const frame = FindFrameAt(input.sequence, stamp);
    if (frame != nullptr && !(frame->depth.empty() && frame->right.empty())) {
      chosen.push_back({static_cast<size_t>(frame - input.sequence.frames.data()), i});
    }
  }
  if (chosen.empty()) {
    throw InputError(fmt::format(
        "no frame of the sequence with depth has the time stamp of a chosen pose ({} poses, {} "
        "keyframes), expected the sequence of the run; a run that only localised needs --every N",
        input.poses.size(), input.keyframes.size()));
  }
  return chosen;
}

// The velocity of points between the neighbours of a pose.
PointVelocity VelocityAt(const Trajectory& poses, size_t index) {
  constexpr double kMostGap = 0.25;  // s
  const auto is_near = [&](size_t other) {
    return std::abs(poses[other].timestamp - poses[index].timestamp) <= kMostGap;
  };
  const size_t before = index > 0 && is_near(index - 1) ? index - 1 : index;
  const size_t after = index + 1 < poses.size() && is_near(index + 1) ? index + 1 : index;
  const double duration = poses[after].timestamp - poses[before].timestamp;
  return duration > 0.0
             ? MeanVelocity(Inverse(poses[after].world_from_cam) * poses[before].world_from_cam,
                            duration)
             : PointVelocity{};
}

// The depth image of a frame, of the size of the camera.
cv::Mat ReadDepth(const MeshInput& input, const FramePaths& frame, TaskRunner& runner) {
  const PinholeCamera& camera = input.options.camera;
  if (frame.depth.empty()) {
    const ImageInput pair = input.sequence.load(frame, camera);
    return CoarseDepth(pair.grey, pair.right, camera,
                       {cv::Rect(0, 0, camera.width, camera.height), {}}, runner);
  }
  const DepthOptions& depth = input.options.depth;
  return WithoutDisparityOffset(ReadView(input.sequence, frame, camera, false).depth,
                                depth.disparity_offset, camera.bf, depth.units_per_metre);
}

// The region of a view that may show an object, and the contour of the object in the middle row's
// image.
class ObjectRegion {
 public:
  // `contour` has undistorted pixels, three or more.
  ObjectRegion(const DepthView& view, const std::vector<Eigen::Vector2d>& contour) {
    constexpr int kMargin = 32;  // px, more than a rolling shutter moves pixels
    std::vector<cv::Point> outline;
    for (const Eigen::Vector2d& point : contour) {
      outline.emplace_back(cvRound(point.x()), cvRound(point.y()));
      const Eigen::Vector2i raw = view.camera.Distort(point).cast<int>();
      box_ |= cv::Rect(raw.x() - kMargin, raw.y() - kMargin, 2 * kMargin, 2 * kMargin);
    }
    box_ &= cv::Rect({0, 0}, view.inverse_depth.size());
    inside_ = cv::boundingRect(outline);
    filled_ = cv::Mat(inside_.size(), CV_8UC1, cv::Scalar(0));
    cv::fillPoly(filled_, std::vector{outline}, cv::Scalar(255), cv::LINE_8, 0, -inside_.tl());
  }

  const cv::Rect& box() const { return box_; }  // raw px
  bool Contains(const Eigen::Vector2d& undistorted) const {
    const cv::Point at(cvRound(undistorted.x()), cvRound(undistorted.y()));
    return inside_.contains(at) && filled_.at<uint8_t>(at - inside_.tl()) != 0;
  }

 private:
  cv::Rect box_;
  cv::Rect inside_;
  cv::Mat filled_;
};

// The part of a view inside the contour of an object and inside its ellipsoid, which is enlarged,
// because objects are no ellipsoids.
DepthView OnlyObject(const DepthView& view, const Ellipsoid& ellipsoid,
                     const ObjectRegion& region) {
  constexpr double kEnlarged = 1.3;
  const Rigid3& middle = view.cam_from_world[view.cam_from_world.size() / 2];
  const Rigid3 object_from_world = Inverse(ellipsoid.world_from_object);
  DepthView part = view;
  part.inverse_depth = cv::Mat(view.inverse_depth.size(), CV_32FC1, cv::Scalar(0.0));
  std::vector<Rigid3> world_from_cam;
  for (const Rigid3& pose : view.cam_from_world) {
    world_from_cam.push_back(Inverse(pose));
  }
  for (int y = region.box().y; y < region.box().br().y; ++y) {
    for (int x = region.box().x; x < region.box().br().x; ++x) {
      const float inverse = view.inverse_depth.at<float>(y, x);
      if (inverse <= 0.0F) {
        continue;
      }
      const auto& ray = view.rays.at<cv::Vec2f>(y, x);
      const Eigen::Vector3f in_cam = Eigen::Vector3f(ray[0], ray[1], 1.0F) / inverse;
      const Eigen::Vector3d point =
          world_from_cam[view.PoseIndex(Eigen::Vector2d(x, y))] * in_cam.cast<double>();
      const Eigen::Vector3d in_object = object_from_world * point;
      if (in_object.cwiseQuotient(ellipsoid.half_axes).norm() <= kEnlarged &&
          region.Contains(view.camera.Project(middle * point))) {
        part.inverse_depth.at<float>(y, x) = inverse;
      }
    }
  }
  return part;
}

class MeshMaker {
 public:
  MeshMaker(const MeshInput& input, const MeshOptions& options, TaskRunner& runner)
      : input_(input),
        options_(options),
        runner_(runner),
        frames_(ChooseFrames(input, options.every)) {
    rays_ = RaysOf(input.options.camera, seen_);
    if (!input.options.mask_all.empty()) {
      seen_.setTo(0, input.options.mask_all == 0);
    }
    if (input.masks != nullptr) {
      names_ = MaskFrames(input.sequence);
    }
    const PinholeCamera& camera = input.options.camera;
    max_depth_ =
        options.max_depth.value_or(input.options.depth.close_baselines * camera.bf / camera.fx);
  }

  std::optional<Mesh> Make(const std::function<bool(size_t, size_t)>& go_on) {
    voxel_ = options_.voxel.value_or(0.0);
    if (!options_.voxel) {
      voxel_ = ChooseVoxel();
    }
    for (;; voxel_ *= 2.0) {
      const Outcome outcome = AddViews(go_on);
      if (outcome == Outcome::kStopped) {
        return std::nullopt;
      }
      if (outcome == Outcome::kDone) {
        return Extract();
      }
      if (options_.voxel) {
        throw InputError(fmt::format(
            "voxels of {:g} m need more than {} blocks of memory, expected larger ones (--voxel) "
            "or a smaller --max-depth",
            voxel_, kMostBlocks));
      }
    }
  }

 private:
  enum class Outcome { kDone, kStopped, kTooLarge };

  // The median depth over 150, rounded to one digit: 1 cm at 1.5 m.
  double ChooseVoxel() const {
    std::vector<float> depths;
    for (const MeshFrame& frame : Thin(frames_, 8)) {
      const DepthView view = ReadView(frame);
      for (int y = 0; y < view.inverse_depth.rows; y += 4) {
        for (int x = 0; x < view.inverse_depth.cols; x += 4) {
          if (const float inverse = view.inverse_depth.at<float>(y, x); inverse > 0.0F) {
            depths.push_back(1.0F / inverse);
          }
        }
      }
    }
    if (depths.empty()) {
      throw InputError(fmt::format(
          "the depth images have no usable depth up to {:g} m, expected a larger --max-depth",
          max_depth_));
    }
    const double wanted = static_cast<double>(Median(std::move(depths))) / 150.0;
    const double power = std::pow(10.0, std::floor(std::log10(wanted)));
    return power * std::round(wanted / power);
  }

  // The view of a frame, without things that move.
  DepthView ReadView(const MeshFrame& chosen) const {
    const FramePaths& frame = input_.sequence.frames[chosen.frame];
    const PinholeCamera& camera = input_.options.camera;
    cv::Mat depth = ReadDepth(input_, frame, runner_).clone();
    depth.setTo(0, seen_ == 0);
    if (input_.masks != nullptr) {
      std::vector<InstanceMask> masks = input_.masks->Read(names_[chosen.frame]).masks;
      FitMasks(input_.sequence.warps, ImageSide::kLeft, masks);
      ValidateMasks(masks, camera.width, camera.height);
      const cv::Mat moving =
          DynamicMask(masks, SplitNames(input_.options.tracking.dynamic_classes), depth.size());
      if (!moving.empty()) {
        depth.setTo(0, moving);
      }
    }
    DepthView view = MakeDepthView(depth, input_.options, max_depth_, rays_, runner_);
    view.colour = LoadColour(input_.sequence, frame, camera);
    view.cam_from_world =
        PosesOfRows(input_.options, Inverse(input_.poses[chosen.pose].world_from_cam),
                    VelocityAt(input_.poses, chosen.pose));
    return view;
  }

  Outcome AddViews(const std::function<bool(size_t, size_t)>& go_on) {
    scene_.emplace(voxel_, kTruncation * voxel_);
    objects_.clear();
    blocks_ = 0;
    for (size_t i = 0; i < frames_.size(); ++i) {
      const DepthView view = ReadView(frames_[i]);
      if (!AddTo(*scene_, view) || !AddToObjects(input_.poses[frames_[i].pose], view)) {
        return Outcome::kTooLarge;
      }
      if (!go_on(i + 1, frames_.size())) {
        return Outcome::kStopped;
      }
    }
    return Outcome::kDone;
  }

  bool AddTo(VoxelVolume& volume, const DepthView& view) {
    const size_t before = volume.blocks().size();
    const bool has_room = volume.Add(view, kMostBlocks - (blocks_ - before), runner_);
    blocks_ += volume.blocks().size() - before;
    return has_room;
  }

  // Adds a keyframe's view of its objects to their volumes.
  bool AddToObjects(const StampedPose& pose, const DepthView& view) {
    for (const ObjectResult& object : input_.objects) {
      const auto seen = std::ranges::find_if(object.observations, [&](const auto& observation) {
        return std::abs(observation.timestamp - pose.timestamp) <= kSameMoment;
      });
      if (seen == object.observations.end() || seen->contour.size() < 3) {
        continue;
      }
      auto [volume, is_new] = objects_.try_emplace(object.id, voxel_, kTruncation * voxel_);
      if (!AddTo(volume->second,
                 OnlyObject(view, object.ellipsoid, ObjectRegion(view, seen->contour)))) {
        return false;
      }
    }
    return true;
  }

  Mesh Extract() {
    Mesh mesh{.scene = WithoutSmallParts(ExtractSurface(*scene_, runner_), kLeastTriangles),
              .objects = {},
              .up = input_.up,
              .voxel = voxel_,
              .truncation = scene_->truncation(),
              .max_depth = max_depth_,
              .views = frames_.size()};
    for (const ObjectResult& object : input_.objects) {
      if (const auto volume = objects_.find(object.id); volume != objects_.end()) {
        SurfaceMesh surface =
            WithoutSmallParts(ExtractSurface(volume->second, runner_), kLeastTriangles);
        if (!surface.triangles.empty()) {
          mesh.objects.push_back({object.id, object.label, std::move(surface)});
        }
      }
    }
    return mesh;
  }

  const MeshInput& input_;
  const MeshOptions& options_;
  TaskRunner& runner_;
  std::vector<MeshFrame> frames_;
  std::vector<MaskFrame> names_;  // one per frame of the sequence, if there are masks
  cv::Mat rays_;
  cv::Mat seen_;            // CV_8UC1, 0 at raw pixels that are not used
  double max_depth_ = 0.0;  // m
  double voxel_ = 0.0;      // m
  size_t blocks_ = 0;       // of all volumes
  std::optional<VoxelVolume> scene_;
  std::map<ObjectId, VoxelVolume> objects_;
};

}  // namespace

std::optional<Mesh> MakeMesh(const MeshInput& input, const MeshOptions& options, TaskRunner& runner,
                             const std::function<bool(size_t done, size_t all)>& go_on) {
  return MeshMaker(input, options, runner).Make(go_on);
}

}  // namespace hullslam
