// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/frame_chooser.h"

#include <algorithm>
#include <numbers>
#include <utility>

namespace hullslam {

bool FrameChooser::Choose(const Rigid3& world_from_cam,
                          const std::function<std::vector<InstanceMask>()>& read_masks) {
  constexpr double kSmallMotion = 0.25;
  if (last_ && !HasMoved(world_from_cam, kSmallMotion)) {
    return false;
  }
  std::vector<LabelledBox> boxes = BoxesOf(read_masks());
  if (last_ && !HasMoved(world_from_cam, 1.0) && !HasMaskMoved(boxes)) {
    return false;
  }
  last_ = world_from_cam;
  last_boxes_ = std::move(boxes);
  return true;
}

std::vector<FrameChooser::LabelledBox> FrameChooser::BoxesOf(
    const std::vector<InstanceMask>& masks) {
  std::vector<LabelledBox> boxes;
  for (const InstanceMask& mask : masks) {
    LabelledBox& labelled = boxes.emplace_back();
    labelled.label = mask.label;
    for (const auto& outline : mask.outlines) {
      for (const Eigen::Vector2d& point : outline) {
        labelled.box.extend(point);
      }
    }
  }
  return boxes;
}

// Whether the camera has moved by `share` times the least distance, or has turned by `share` times
// the least angle.
bool FrameChooser::HasMoved(const Rigid3& pose, double share) const {
  const double angle = AngularDistance(last_->rotation, pose.rotation) * 180.0 / std::numbers::pi;
  return (pose.translation - last_->translation).norm() >= share * choice_.min_distance ||
         angle >= share * choice_.min_angle;
}

// Whether a mask has moved by more than half of its size, or is new.
bool FrameChooser::HasMaskMoved(const std::vector<LabelledBox>& boxes) const {
  constexpr double kMostMoved = 0.5;
  return std::any_of(boxes.begin(), boxes.end(), [&](const LabelledBox& now) {
    return std::none_of(last_boxes_.begin(), last_boxes_.end(), [&](const LabelledBox& then) {
      return now.label == then.label && (now.box.center() - then.box.center()).norm() <=
                                            kMostMoved * now.box.sizes().minCoeff();
    });
  });
}

ChosenViews ChooseViews(std::span<const double> stamps, const Trajectory& poses, double max_gap,
                        const FrameChoice& choice,
                        const std::function<std::vector<InstanceMask>(size_t)>& read_masks) {
  ChosenViews chosen;
  FrameChooser chooser(choice);
  for (size_t i = 0; i < stamps.size(); ++i) {
    const auto pose = InterpolatePose(poses, stamps[i], max_gap);
    if (!pose) {
      ++chosen.without_pose;
    } else if (chooser.Choose(*pose, [&] { return read_masks(i); })) {
      chosen.views.push_back({i, *pose});
    }
  }
  return chosen;
}

}  // namespace hullslam
