// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>

#include "hullslam/frame/frame.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/map/map.h"
#include "hullslam/system/options.h"
#include "hullslam/util/eigen_alignment.h"

namespace hullslam {

struct Sensor;
class ObjectIndex;

// The method by which the first pose of a frame was found.
enum class RelocalisationMethod { kWords, kObjects };

const char* ToString(RelocalisationMethod method);

struct RelocalisedPose {
  Rigid3 cam_from_world;
  RelocalisationMethod method = RelocalisationMethod::kWords;
  int inliers = 0;       // landmarks that agree with the pose
  int used_objects = 0;  // objects that constrain the pose
};

// Finds the poses of single frames in a map without knowing the frames before them, like a tracker
// that is lost. Frames come from System::Build() of a system with the same camera and image pyramid
// as the map.
class Relocaliser {
 public:
  // `map` is not null. The options are used for the frames and for tracking. Throws InputError if
  // SystemOptions::Validate does.
  Relocaliser(const SystemOptions& options, std::shared_ptr<const Map> map);
  ~Relocaliser();
  Relocaliser(const Relocaliser&) = delete;
  Relocaliser& operator=(const Relocaliser&) = delete;

  // Null if the frame is not recognised, or if it fits two places of the map. The same frame,
  // options and map give the same bits.
  std::optional<RelocalisedPose> Find(const Frame& frame) const;

 private:
  const SystemOptions options_;
  const std::shared_ptr<const Map> map_;
  const std::unique_ptr<const Sensor> sensor_;
  const std::unique_ptr<const ObjectIndex> object_index_;
};

}  // namespace hullslam
