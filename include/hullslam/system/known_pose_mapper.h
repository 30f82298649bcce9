// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "hullslam/frame/instance_mask.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/map/map.h"
#include "hullslam/system/options.h"
#include "hullslam/system/system.h"
#include "hullslam/util/eigen_alignment.h"

namespace hullslam {

// Maps objects from masks and known camera poses, for example of odometry or motion capture. It
// needs no images, tracks nothing and changes no pose.
//
//   KnownPoseMapper mapper(options);
//   for each view: mapper.AddView(timestamp, world_from_cam, masks, depth);
//   for (const auto& [id, object] : mapper.map().objects()) ...
//
// A view should differ from the one before. If the camera hardly moves, add only some of its
// frames. Without depth, an object is only recognised in the next view if the translation of the
// camera moves its outline by less than the size of the outline.
class KnownPoseMapper {
 public:
  // Uses the camera, depth, objects and tracking.dynamic_classes of the options. Throws InputError
  // if SystemOptions::Validate does.
  explicit KnownPoseMapper(const SystemOptions& options);
  ~KnownPoseMapper();
  KnownPoseMapper(const KnownPoseMapper&) = delete;
  KnownPoseMapper& operator=(const KnownPoseMapper&) = delete;

  // Adds a keyframe at the pose of the camera (m), with the masks of its image in raw pixels and
  // optionally its depth image as in ImageInput. Masks of the dynamic classes are left out. Throws
  // InputError for masks that ValidateMasks() refuses and for a depth image of another size or
  // type, and CheckError for a time stamp (s) or a pose that is not finite. A refused view changes
  // nothing.
  void AddView(double timestamp, const Rigid3& world_from_cam, std::vector<InstanceMask> masks,
               const cv::Mat& depth = {});

  // The views as keyframes, and the objects: those whose state is ObjectState::kMapped have a
  // quadric that fits their views, the others are candidates.
  const Map& map() const;
  // A copy of map(), which later views do not change. It takes microseconds.
  Map Snapshot();
  // The numbers of masks that gave detections, and of rejected masks and objects by reason.
  ObjectCounts counts() const;
  // Messages for the user about input that can be used, but hardly is what was meant: depth in
  // another unit, and poses in another unit than the depth.
  std::vector<std::string> warnings() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hullslam
