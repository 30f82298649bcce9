// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hullslam/frame/instance_mask.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/geometry/trajectory.h"

namespace hullslam {

// How far the camera moves or turns between two views that are used.
struct FrameChoice {
  double min_distance = 0.05;  // m
  double min_angle = 5.0;      // degrees
};

// Chooses the frames of a sequence that a KnownPoseMapper is given: those at which the camera has
// moved or turned enough since the last chosen frame. If a mask has moved by more than half of its
// size, or is new, a quarter of that motion is enough. This gives small objects that are seen for a
// short time enough views, and it keeps neighbouring views of an object similar enough for
// association.
class FrameChooser {
 public:
  explicit FrameChooser(const FrameChoice& choice = {}) : choice_(choice) {}

  // Whether the next frame, with this pose (m), is chosen. The first one always is. `read_masks`
  // gives the masks of the frame; it is called only if they matter.
  bool Choose(const Rigid3& world_from_cam,
              const std::function<std::vector<InstanceMask>()>& read_masks);

 private:
  struct LabelledBox {
    std::string label;
    Eigen::AlignedBox2d box;  // raw px
  };

  static std::vector<LabelledBox> BoxesOf(const std::vector<InstanceMask>& masks);
  bool HasMoved(const Rigid3& pose, double share) const;
  bool HasMaskMoved(const std::vector<LabelledBox>& boxes) const;

  FrameChoice choice_;
  std::optional<Rigid3> last_;           // the pose of the last chosen frame
  std::vector<LabelledBox> last_boxes_;  // around its masks
};

// A frame that is used for mapping.
struct ChosenView {
  size_t frame = 0;  // index in the sequence
  Rigid3 world_from_cam;
};

struct ChosenViews {
  std::vector<ChosenView> views;
  size_t without_pose = 0;  // frames
};

// Chooses from the frames with these stamps, s. A pose is interpolated between two poses that are
// at most `max_gap` apart, s. `read_masks` gives the masks of the frame with an index.
ChosenViews ChooseViews(std::span<const double> stamps, const Trajectory& poses, double max_gap,
                        const FrameChoice& choice,
                        const std::function<std::vector<InstanceMask>(size_t)>& read_masks);

}  // namespace hullslam
